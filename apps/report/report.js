// The page of a comparison. Data come from data.js; everything in them is shown as text, never as markup, except the
// plot, in which names were escaped when it was made.
"use strict";

(() => {
  const {header, scale, pictures, runs, frontier} = window.pellucidReport;

  // ---- Small helpers

  const byId = (id) => document.getElementById(id);
  const unique = (values) => [...new Set(values)];
  const plural = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;

  /** An element with properties and children, which may be text. */
  function element(tag, properties = {}, ...children) {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
  }

  /** Fills a select with [value, text] pairs and chooses `chosen`, or the first where that is none of them. */
  function fill(select, pairs, chosen) {
    select.replaceChildren(...pairs.map(([value, text]) => element("option", {value, textContent: text})));
    const known = pairs.some(([value]) => value === String(chosen));
    if (pairs.length > 0) select.value = known ? chosen : pairs[0][0];
    return select.value;
  }

  // ---- What there is

  const EXACT = "";  // the technique of the exact pictures
  const scenes = unique([...pictures, ...runs].map((of) => of.scene));
  const techniques = unique([...runs, ...pictures].map((of) => of.technique).filter((name) => name !== EXACT));
  const KINDS = [["image", "Image"], ["error", "Error map"], ["flip", "FLIP map"], ["analysis", "Analysis"]];
  const kinds = KINDS.filter(([kind]) => pictures.some((picture) => picture.kind === kind));

  const keyOf = (...parts) => JSON.stringify(parts);
  const pictureAt = new Map(pictures.map((p) => [keyOf(p.scene, p.view, p.technique, p.kind), p]));
  const runAt = new Map(runs.map((run) => [keyOf(run.scene, run.view, run.technique), run]));

  const lastPart = (name) => name.split("/").filter(Boolean).pop() || name;
  const lastPartCount = new Map();
  for (const scene of scenes) lastPartCount.set(lastPart(scene), (lastPartCount.get(lastPart(scene)) || 0) + 1);

  /** Scenes may be long paths: their last part where that says which. */
  const sceneName = (scene) => lastPartCount.get(lastPart(scene)) === 1 ? lastPart(scene) : scene;
  const techniqueName = (technique) => technique === EXACT ? "exact reference" : technique;

  // ---- Numbers

  const asShare = (value) => (100 * value).toFixed(2);
  const asCount = (value) => value.toLocaleString("en");
  const fixed = (digits) => (value) => value.toFixed(digits);

  const NAMES = [{key: "scene", label: "Scene"}, {key: "view", label: "View", format: String},
                 {key: "technique", label: "Technique"}];
  const ACCURACY = [
    {key: "within_1deg_stable", label: "Within 1°,\nstable %", format: asShare, best: Math.max},
    {key: "within_1deg", label: "Within 1° %", format: asShare, best: Math.max},
    {key: "within_5deg", label: "Within 5° %", format: asShare, best: Math.max},
    {key: "median_deg", label: "Median °", format: fixed(3), best: Math.min},
    {key: "p95_deg", label: "95% °", format: fixed(2), best: Math.min},
    {key: "flip_mean", label: "FLIP", format: fixed(4), best: Math.min},
    {key: "rmse", label: "RMSE", format: fixed(4), best: Math.min},
    {key: "frame_ms", label: "Frame ms", format: fixed(2), best: Math.min},
  ];
  const PERCENTILES = ["median_deg", "p95_deg"];
  const EVENTS = [["2", "≤ 2"], ["4", "3–4"], ["more", "> 4"], ["tir", "TIR"]].flatMap(([key, label]) => [
    {key: `by_events.${key}.share`, label: `${label},\nshare %`, format: asShare},
    {key: `by_events.${key}.within_1deg`, label: "\nwithin 1° %", format: asShare, best: Math.max},
  ]);
  const STATUS = unique(runs.flatMap((run) => Object.keys(run.status || {})))
      .map((key) => ({key: `status.${key}`, label: `${key.replaceAll("_", " ")} %`, format: asShare}));
  const SCENE = [
    {key: "stable_share", label: "Stable %", format: asShare},
    {key: "self_within_1deg", label: "Exact, shifted %", format: asShare},
    {key: "covered", label: "Covered pixels", format: asCount},
    {key: "triangles", label: "Triangles", format: asCount},
    {key: "width", label: "Width", format: String},
    {key: "height", label: "Height", format: String},
  ];
  const GROUPS = [["accuracy", "Accuracy and time", ACCURACY], ["events", "By events", EVENTS],
                  ["status", "Status", STATUS], ["scene", "Scene", SCENE]];

  /** The value at a key such as "status.ok"; undefined where it was not measured. */
  function valueOf(run, key) {
    const value = key.split(".").reduce((part, name) => part?.[name], run);
    return value === null ? undefined : value;
  }
  const isMeasured = (column, rows) => rows.some((row) => valueOf(row, column.key) !== undefined);

  // ---- Tables that sort

  /** Missing values come last, whichever the direction. */
  function compareBy(key, direction) {
    return (a, b) => {
      const x = valueOf(a, key), y = valueOf(b, key);
      if (x === undefined || y === undefined) return (x === undefined) - (y === undefined);
      const order = typeof x === "number" ? x - y : String(x).localeCompare(String(y), "en", {numeric: true});
      return direction === "ascending" ? order : -order;
    };
  }

  function cell(column, row, best, onName) {
    const value = valueOf(row, column.key);
    if (column.format) {
      const node = element("td", {textContent: value === undefined ? "–" : column.format(value)});
      node.classList.toggle("missing", value === undefined);
      node.classList.toggle("best", value !== undefined && value === best);
      return node;
    }
    const text = column.key === "scene" ? sceneName(value) : value;
    const node = element("td", {className: "name", title: value});
    const leads = column.key === "scene" && onName;
    node.append(leads ? element("button", {type: "button", textContent: text, onclick: () => onName(row)}) : text);
    return node;
  }

  /** Shows rows in a table whose headings sort it; the order is kept in the table between calls. */
  function showTable(table, columns, rows, {onName, markBest} = {}) {
    if (!columns.some((column) => column.key === table.sortKey)) table.sortKey = undefined;
    const sorted = table.sortKey ? [...rows].sort(compareBy(table.sortKey, table.sortDirection)) : rows;
    const sortBy = (column) => {
      const first = column.best === Math.max ? "descending" : "ascending";
      const other = first === "ascending" ? "descending" : "ascending";
      table.sortDirection = table.sortKey === column.key && table.sortDirection === first ? other : first;
      table.sortKey = column.key;
      showTable(table, columns, rows, {onName, markBest});
      table.tHead.rows[0].cells[columns.indexOf(column)].firstChild.focus();
    };
    const headings = columns.map((column) => {
      const button = element("button", {type: "button", textContent: column.label, onclick: () => sortBy(column)});
      const heading = element("th", {scope: "col", className: column.format ? "" : "name"}, button);
      if (column.key === table.sortKey) heading.ariaSort = table.sortDirection;
      return heading;
    });
    const best = columns.map((column) => markBest && column.best && rows.length > 1 ?
      column.best(...rows.map((row) => valueOf(row, column.key)).filter((value) => value !== undefined)) : undefined);
    const lines = sorted.map((row) =>
      element("tr", {}, ...columns.map((column, i) => cell(column, row, best[i], onName))));
    table.replaceChildren(element("thead", {}, element("tr", {}, ...headings)), element("tbody", {}, ...lines));
  }

  // ---- The two pictures

  const chosen = {scene: scenes[0], view: 0, kind: "image", left: EXACT, right: techniques[0], worstOf: undefined};

  /** The picture of a technique as chosen; its image where it has no such map, as the exact reference. */
  function pictureOf(technique) {
    const at = (kind) => pictureAt.get(keyOf(chosen.scene, chosen.view, technique, kind));
    return at(chosen.kind) || at("image");
  }

  function describe(technique) {
    const picture = pictureOf(technique);
    const shown = picture && picture.kind !== "image" ? KINDS.find(([kind]) => kind === picture.kind)[1] : "Image";
    return `${shown} of ${sceneName(chosen.scene)}, view ${chosen.view}, ${techniqueName(technique)}`;
  }

  function showSide(side) {
    const technique = chosen[side];
    const picture = pictureOf(technique);
    const image = byId(`${side}-picture`);
    image.hidden = !picture;
    if (picture && image.getAttribute("src") !== picture.file) image.src = picture.file;
    image.alt = describe(technique);
    byId(`${side}-caption`).replaceChildren(element("b", {textContent: techniqueName(technique)}),
                                            element("span", {textContent: sideNumbers(technique, picture)}));
  }

  function sideNumbers(technique, picture) {
    if (!picture) return "no picture";
    if (technique === EXACT) return picture.kind === chosen.kind ? header.reference : "its image: it has no such map";
    const run = runAt.get(keyOf(chosen.scene, chosen.view, technique)) || {};
    const numbers = [];
    if (picture.kind !== chosen.kind) numbers.push("its image: there is no such map");
    if (run.within_1deg !== undefined) numbers.push(`${asShare(run.within_1deg)}% within 1°`);
    if (run.flip_mean !== undefined) numbers.push(`FLIP ${run.flip_mean.toFixed(4)}`);
    if (run.frame_ms !== undefined) numbers.push(`${run.frame_ms.toFixed(2)} ms`);
    return numbers.join(" · ");
  }

  function moveSplit(percent) {
    const clamped = Math.min(100, Math.max(0, percent));
    const handle = byId("handle");
    byId("split").style.setProperty("--split", `${clamped}%`);
    handle.ariaValueNow = String(Math.round(clamped));
    handle.ariaValueText =
        `${Math.round(clamped)}% ${techniqueName(chosen.left)}, the rest ${techniqueName(chosen.right)}`;
  }
  const splitAt = () => parseFloat(byId("split").style.getPropertyValue("--split"));

  function setUpSplit() {
    const split = byId("split");
    const follow = (event) => {
      const box = split.getBoundingClientRect();
      moveSplit(100 * (event.clientX - box.left) / box.width);
    };
    split.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      split.setPointerCapture(event.pointerId);
      byId("handle").focus({preventScroll: true});
      event.preventDefault();
      follow(event);
    });
    split.addEventListener("pointermove", (event) => {
      if (split.hasPointerCapture(event.pointerId)) follow(event);
    });
    const steps = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10,
                   Home: -100, End: 100};
    byId("handle").addEventListener("keydown", (event) => {
      const step = steps[event.key];
      if (step === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      moveSplit(splitAt() + step * (event.shiftKey ? 10 : 1));
    });
    moveSplit(50);
  }

  // ---- Legends

  const errorShare = (degrees) => Math.log(degrees / scale.least_deg) / Math.log(scale.greatest_deg / scale.least_deg);

  function showLegend() {
    const legend = byId("legend");
    const bar = element("div", {className: "bar", role: "presentation"});
    bar.style.background = `linear-gradient(to right, ${scale.colors.join(", ")})`;
    const ticks = (values, shareOf, unit) => element("ul", {className: "ticks"}, ...values.map((value) => {
      const isBound = unit === "°" && (value === 1 || value === 5);  // what the shares are counted by
      const tick = element("li", {textContent: `${value}${unit}`, className: isBound ? "main" : ""});
      tick.style.left = `${100 * shareOf(value)}%`;
      return tick;
    }));
    if (chosen.kind === "error") {
      const swatch = element("span", {className: "swatch"});
      swatch.style.background = scale.uncovered;
      const values = [scale.least_deg, 0.1, 1, 5, 30, scale.greatest_deg];
      legend.replaceChildren(bar, ticks(values, errorShare, "°"), element("p", {}, swatch, "not covered by glass"));
    } else if (chosen.kind === "flip") {
      legend.replaceChildren(bar, ticks([0, 0.25, 0.5, 0.75, 1], (value) => value, ""));
    } else if (chosen.kind === "analysis") {
      legend.textContent = "Red: up to two interfaces. Blue: more. Green: total internal reflection. Grey: no answer.";
    } else {
      legend.replaceChildren();
    }
  }

  // ---- The worst region

  /** The map whose worst region is meant: the one on show, else the error. */
  const mapOf = (technique) => [chosen.kind, "error", "flip"]
      .map((kind) => pictureAt.get(keyOf(chosen.scene, chosen.view, technique, kind)))
      .find((picture) => picture?.worst);

  function showWorst() {
    const candidates = unique([chosen.right, chosen.left]).filter(mapOf);
    byId("worst").hidden = byId("region").hidden = candidates.length === 0;
    if (candidates.length === 0) return;
    chosen.worstOf = fill(byId("worst-of"), candidates.map((name) => [name, techniqueName(name)]), chosen.worstOf);
    const map = mapOf(chosen.worstOf), {x, y, size, mean} = map.worst;
    const value = map.kind === "error" ? `error ${mean.toFixed(2)}°` : `FLIP ${mean.toFixed(3)}`;
    byId("worst-where").textContent = `${size} × ${size} pixels, ${x} from the left and ${y} from the top; ` +
        `mean ${value}, with 0 where there is no glass.`;
    const percent = (part, whole) => `${100 * part / whole}%`;
    Object.assign(byId("region").style, {left: percent(x, map.width), top: percent(y, map.height),
                                         width: percent(size, map.width), height: percent(size, map.height)});
    const shown = unique([chosen.left, chosen.right, EXACT]).filter(pictureOf);
    byId("crops").replaceChildren(...shown.map((technique) => crop(technique, map.worst)));
  }

  function crop(technique, {x, y, size}) {
    const canvas = element("canvas", {width: size, height: size, role: "img",
                                      ariaLabel: `Worst region: ${describe(technique)}`});
    const image = new Image();
    image.onload = () => canvas.getContext("2d").drawImage(image, x, y, size, size, 0, 0, size, size);
    image.src = pictureOf(technique).file;
    return element("figure", {}, canvas, element("figcaption", {textContent: techniqueName(technique)}));
  }

  // ---- Putting it together

  function showPictures() {
    const here = pictures.filter((picture) => picture.scene === chosen.scene);
    const views = unique(here.map((picture) => picture.view));
    chosen.view = Number(fill(byId("view"), views.map((view) => [String(view), String(view)]), chosen.view));
    const present = unique(here.filter((picture) => picture.view === chosen.view).map((picture) => picture.technique));
    const sides = [EXACT, ...techniques].filter((name) => present.includes(name))
        .map((name) => [name, techniqueName(name)]);
    chosen.left = fill(byId("left"), sides, chosen.left);
    chosen.right = fill(byId("right"), sides, chosen.right);
    const picture = pictureOf(chosen.left) || pictureOf(chosen.right) || {width: 1, height: 1};
    byId("split").style.setProperty("--aspect", picture.width / picture.height);
    showSide("left");
    showSide("right");
    moveSplit(splitAt());
    showLegend();
    showWorst();
  }

  function setUpPictures() {
    byId("pictures").hidden = pictures.length === 0;
    if (pictures.length === 0) return;
    const pictured = unique(pictures.map((picture) => picture.scene));
    chosen.scene = fill(byId("scene"), pictured.map((scene) => [scene, sceneName(scene)]), chosen.scene);
    chosen.kind = fill(byId("kind"), kinds, chosen.kind);
    setUpSplit();
    for (const [id, key] of [["scene", "scene"], ["kind", "kind"], ["left", "left"], ["right", "right"],
                             ["worst-of", "worstOf"]])
      byId(id).addEventListener("change", (event) => { chosen[key] = event.target.value; showPictures(); });
    byId("view").addEventListener("change", (event) => { chosen.view = Number(event.target.value); showPictures(); });
    showPictures();
  }

  /** Leads from a row of the table to its pictures. */
  function choose(run) {
    Object.assign(chosen, {scene: run.scene, view: run.view, right: run.technique, worstOf: run.technique});
    byId("scene").value = run.scene;
    showPictures();
    byId("pictures").scrollIntoView();
    byId("handle").focus({preventScroll: true});
  }

  function meansOf(technique) {
    const own = runs.filter((run) => run.technique === technique);
    const means = {technique, runs: own.length};
    for (const {key} of ACCURACY) {
      if (PERCENTILES.includes(key)) continue;  // the mean of percentiles is no percentile
      const values = own.map((run) => valueOf(run, key)).filter((value) => value !== undefined);
      if (values.length > 0) means[key] = values.reduce((sum, value) => sum + value, 0) / values.length;
    }
    return means;
  }

  function setUpMeans() {
    const rows = unique(runs.map((run) => run.technique)).map(meansOf);
    const columns = [NAMES[2], {key: "runs", label: "Runs", format: String},
                     ...ACCURACY.filter((column) => isMeasured(column, rows))];
    byId("means-note").textContent = `Over all scenes and views, each counted alike.` +
        (unique(rows.map((row) => row.runs)).length > 1 ? " Not every technique ran on all of them." : "");
    showTable(byId("means-table"), columns, rows, {markBest: true});
    if (frontier) byId("frontier").innerHTML = frontier;
    else byId("frontier").textContent = "No times were measured: there is nothing to plot.";
  }

  function showRuns() {
    const scene = byId("filter-scene").value, technique = byId("filter-technique").value;
    const rows = runs.filter((run) => (scene === "" || scene === `=${run.scene}`) &&
                                      (technique === "" || technique === `=${run.technique}`));
    const group = GROUPS.find(([key]) => key === byId("columns").value);
    const columns = group ? group[2].filter((column) => isMeasured(column, runs)) : [];
    byId("runs-note").textContent = rows.length === runs.length ? plural(runs.length, "run") :
      `${rows.length} of ${plural(runs.length, "run")}`;
    showTable(byId("runs-table"), [...NAMES, ...columns], rows, {onName: pictures.length > 0 ? choose : undefined});
  }

  function setUpRuns() {
    // "=" before a name: no name is the same as "all".
    fill(byId("filter-scene"), [["", "all"], ...scenes.map((scene) => [`=${scene}`, sceneName(scene)])]);
    fill(byId("filter-technique"), [["", "all"], ...techniques.map((technique) => [`=${technique}`, technique])]);
    fill(byId("columns"), GROUPS.filter(([, , columns]) => columns.some((column) => isMeasured(column, runs))));
    for (const id of ["filter-scene", "filter-technique", "columns"]) byId(id).addEventListener("change", showRuns);
    showRuns();
  }

  function showHeader() {
    const views = unique([...pictures, ...runs].map((of) => of.view)).length;
    byId("extent").textContent = `How near ${plural(techniques.length, "technique")} ` +
        `${techniques.length === 1 ? "comes" : "come"} to exact refraction, on ${plural(scenes.length, "scene")} from ` +
        `${plural(views, "view")}.`;
    document.title = `Pellucid: ${techniques.join(", ")} on ${scenes.map(sceneName).slice(0, 3).join(", ")}` +
        (scenes.length > 3 ? " and others" : "");
    const facts = [["Device", header.device], ["Driver", header.driver], ["Pellucid", header.version],
                   ["Reference", header.reference], ["Command", header.command]];
    for (const [name, value] of facts.filter(([, text]) => text))
      byId("facts").append(element("dt", {textContent: name}),
                           element("dd", {}, name === "Command" ? element("code", {textContent: value}) : value));
  }

  showHeader();
  setUpPictures();
  setUpMeans();
  setUpRuns();
})();
