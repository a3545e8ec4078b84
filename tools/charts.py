"""Charts as SVG, drawn by hand so that they need no library: points and lines over logarithmic or linear axes."""
import math
from dataclasses import dataclass, field

COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#555555", "#8a5a00"]  # Okabe and Ito
FONT = "font-family='sans-serif' font-size='12'"
LEFT, RIGHT, TOP, BOTTOM = 62, 170, 34, 46  # pixels around the axes; names of series stand on the right


@dataclass
class Axis:
    name: str
    logarithmic: bool = False
    low: float | None = None  # of the values, if not given
    high: float | None = None

    def fit(self, values):
        low = min(values) if self.low is None else self.low
        high = max(values) if self.high is None else self.high
        if self.logarithmic:
            return Axis(self.name, True, low / 1.3, high * 1.3)
        return Axis(self.name, False, low, high)

    def place(self, value):
        """0 at the low end, 1 at the high one."""
        if self.logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def ticks(self):
        if not self.logarithmic:
            return [self.low + i * (self.high - self.low) / 4 for i in range(5)]
        decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
        few = len(decades) > 4
        ticks = [step * 10.0**decade for decade in decades for step in ((1,) if few else (1, 2, 5))]
        return [tick for tick in ticks if self.low <= tick <= self.high]


@dataclass
class Series:
    name: str
    points: list[tuple[float, float]]
    line: bool = True
    color: str = field(default="")


def number(value):
    return f"{value:,.0f}" if value >= 10 or value == int(value) else f"{value:g}"


def spread(wanted, gap):
    """The places nearest to those wanted, in their order, with `gap` between them at least."""
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    places = list(wanted)
    for before, after in zip(order, order[1:]):
        places[after] = max(places[after], places[before] + gap)
    return places


def chart(title, x, y, series, width=640, height=360):
    """SVG text: one chart, each series named at its last point."""
    x = x.fit([px for one in series for px, _ in one.points])
    y = y.fit([py for one in series for _, py in one.points])
    right, bottom = width - RIGHT, height - BOTTOM

    def at(point):
        return LEFT + x.place(point[0]) * (right - LEFT), bottom - y.place(point[1]) * (bottom - TOP)

    parts = [f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}'>",
             f"<rect width='{width}' height='{height}' fill='white'/>",
             f"<text x='{LEFT}' y='20' {FONT} font-weight='bold'>{title}</text>"]
    for tick in x.ticks():
        px = at((tick, y.low))[0]
        parts.append(f"<line x1='{px:.1f}' y1='{TOP}' x2='{px:.1f}' y2='{bottom}' stroke='#ddd'/>"
                     f"<text x='{px:.1f}' y='{bottom + 16}' text-anchor='middle' {FONT}>{number(tick)}</text>")
    for tick in y.ticks():
        py = at((x.low, tick))[1]
        parts.append(f"<line x1='{LEFT}' y1='{py:.1f}' x2='{right}' y2='{py:.1f}' stroke='#ddd'/>"
                     f"<text x='{LEFT - 6}' y='{py + 4:.1f}' text-anchor='end' {FONT}>{number(tick)}</text>")
    parts.append(f"<text x='{(LEFT + right) / 2}' y='{height - 10}' text-anchor='middle' {FONT}>{x.name}</text>"
                 f"<text transform='translate(14 {(TOP + bottom) / 2}) rotate(-90)' text-anchor='middle' {FONT}>{y.name}</text>")
    names = spread([at(one.points[-1])[1] for one in series], 15)
    lowest = max(names)
    names = [place - max(0, lowest - bottom) for place in names]
    for i, one in enumerate(series):
        color = one.color or COLORS[i % len(COLORS)]
        places = [at(point) for point in one.points]
        if one.line:
            parts.append(f"<polyline fill='none' stroke='{color}' stroke-width='2' points='"
                         + " ".join(f"{px:.1f},{py:.1f}" for px, py in places) + "'/>")
        parts += [f"<circle cx='{px:.1f}' cy='{py:.1f}' r='4' fill='{color}'/>" for px, py in places]
        px, py = places[-1]
        parts.append(f"<line x1='{px:.1f}' y1='{py:.1f}' x2='{right + 6}' y2='{names[i]:.1f}' stroke='{color}' stroke-width='0.5'/>"
                     f"<text x='{right + 10}' y='{names[i] + 4:.1f}' fill='{color}' {FONT}>{one.name}</text>")
    return "\n".join(parts) + "\n</svg>\n"
