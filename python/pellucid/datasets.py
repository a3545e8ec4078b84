"""Reads what `pellucid dataset` writes, with NumPy alone, and writes the layouts of published sets.

    for sample in Dataset("out/glass"):
        sample["color"], sample["flow"], sample["instance"], sample["objects"]
"""
import json
import struct
import zlib
from pathlib import Path

import numpy as np

VECTORS = {"color": ("R", "G", "B"), "background": ("background.R", "background.G", "background.B"),
           "flow": ("flow.X", "flow.Y"), "attenuation": ("attenuation.R", "attenuation.G", "attenuation.B"),
           **{f"normal_{which}": tuple(f"normal_{which}.{axis}" for axis in "XYZ") for which in ("first", "second", "last")}}
NUMBERS = {"fresnel": "fresnel", **{f"depth_{which}": f"depth.{which}" for which in ("first", "second", "last", "background")}}
WHOLE = {"events": "events", "reflections": "reflections", "status": "status", "instance": "instance"}
BLOCK_ROWS = 16  # rows of a block that ZIP compresses


def _attributes(data):
    """Attributes of an EXR file's header, and the position behind it."""
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("is no EXR file")
    at, found = 8, {}
    while data[at]:
        name, kind, rest = data[at:at + 600].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, at)
        found[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def _unpacked(block, size):
    """Bytes of a block that ZIP compressed, as OpenEXR defines it: halves interleaved, then differences."""
    if len(block) == size:
        return np.frombuffer(block, np.uint8)
    steps = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    steps[1:] -= 128
    halves = np.cumsum(steps).astype(np.uint8)
    values = np.empty(size, np.uint8)
    values[0::2], values[1::2] = halves[:(size + 1) // 2], halves[(size + 1) // 2:]
    return values


def read_channels(file):
    """dict of the channels of an EXR file as Pellucid writes it (32-bit float, ZIP): float32 (height, width)."""
    data = Path(file).read_bytes()
    attributes, at = _attributes(data)
    names = [entry.decode() for entry in _channel_names(attributes["channels"])]
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    pixels = np.empty((height, len(names), width), np.float32)
    blocks = -(-height // BLOCK_ROWS)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        row, size = struct.unpack_from("<ii", data, offset)
        first, last = row - top, min(row - top + BLOCK_ROWS, height)
        values = _unpacked(data[offset + 8:offset + 8 + size], (last - first) * len(names) * width * 4)
        pixels[first:last] = values.view("<f4").reshape(last - first, len(names), width)
    return {name: pixels[:, i] for i, name in enumerate(names)}


def _channel_names(listed):
    while listed[0]:
        name, rest = listed.split(b"\0", 1)
        yield name
        listed = rest[16:]


def mask_of(runs):
    """bool (height, width) of COCO's uncompressed run lengths."""
    height, width = runs["size"]
    inside = np.arange(len(runs["counts"])) % 2 == 1
    return np.repeat(inside, runs["counts"]).reshape(width, height).T


class Dataset:
    """The images of a folder, in order. Each is read when it is asked for."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.names = sorted(file.stem for file in self.folder.glob("[0-9]*.json"))

    def __len__(self):
        return len(self.names)

    def __getitem__(self, index):
        """dict of one image. Arrays (height, width[, channels]), float32 but for those named otherwise:

        color, background: linear RGB with and without glass. flow: offset in pixels, right and down, from the pixel to
        where its refracted ray meets the background; flow_valid (bool): there is such a place. attenuation: RGB 0..1.
        fresnel: 0..1. depth_first, depth_second, depth_last, depth_background: m along the view axis, 0: none.
        normal_first, normal_second, normal_last: unit, axes right, up and to the viewer. events, reflections, status,
        instance: int32; instance is 0 for the background. camera, objects and the rest are those of the JSON file.
        """
        name = self.names[index]
        channels = read_channels(self.folder / f"{name}.exr")
        sample = json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))
        sample["name"] = name
        sample.update({key: np.stack([channels[c] for c in of], axis=-1) for key, of in VECTORS.items()})
        sample.update({key: np.ascontiguousarray(channels[of]) for key, of in NUMBERS.items()})
        sample.update({key: channels[of].astype(np.int32) for key, of in WHOLE.items()})
        sample["flow_valid"] = channels["flow.valid"] > 0
        return sample


def _png(file, image):
    """Writes grey or RGB, of 8 or 16 bits by the array's type."""
    image = image[..., None] if image.ndim == 2 else image
    height, width, channels = image.shape
    big = np.ascontiguousarray(image, dtype=image.dtype.newbyteorder(">"))
    rows = b"".join(b"\0" + row.tobytes() for row in big)
    head = struct.pack(">IIBBBBB", width, height, 8 * image.dtype.itemsize, 0 if channels == 1 else 2, 0, 0, 0)
    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")
        for kind, content in ((b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")):
            out.write(struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content)))


def _bytes_of(share):
    return (np.clip(share, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _copy(dataset, name, suffix, target):
    target.write_bytes((dataset.folder / f"{name}{suffix}").read_bytes())


def write_tom_net(dataset, folder):
    """Layout of TOM-Net (Chen, Han & Wong 2018): NAME.png, _ref.png (background), _mask.png, _rho.png (attenuation, grey)
    and _flow.flo (Middlebury's format)."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for sample in dataset:
        name, glass = sample["name"], sample["instance"] > 0
        _copy(dataset, name, ".png", folder / f"{name}.png")
        _copy(dataset, name, ".background.png", folder / f"{name}_ref.png")
        _png(folder / f"{name}_mask.png", _bytes_of(glass))
        light = sample["attenuation"].mean(axis=-1) * sample["fresnel"] * sample["flow_valid"]
        _png(folder / f"{name}_rho.png", _bytes_of(np.where(glass, light, 1.0)))
        height, width = glass.shape
        with open(folder / f"{name}_flow.flo", "wb") as file:
            file.write(struct.pack("<fii", 202021.25, width, height) + sample["flow"].astype("<f4").tobytes())


def write_clear_grasp(dataset, folder):
    """Layout of ClearGrasp (Sajjan et al. 2020): rgb-imgs, segmentation-masks, depth-imgs-rectified and camera-normals.
    Depth and normals are those of the first surface, of glass or not; normals have axes right, up and to the viewer."""
    from . import write_image
    folder = Path(folder)
    for part in ("rgb-imgs", "segmentation-masks", "depth-imgs-rectified", "camera-normals"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    for sample in dataset:
        name, glass = f"{sample['image']:09}", sample["depth_first"] > 0
        _copy(dataset, sample["name"], ".png", folder / "rgb-imgs" / f"{name}-rgb.png")
        _png(folder / "segmentation-masks" / f"{name}-segmentation-mask.png", _bytes_of(sample["instance"] > 0))
        depth = np.where(glass, sample["depth_first"], sample["depth_background"])
        write_image(folder / "depth-imgs-rectified" / f"{name}-depth-rectified.exr", depth)
        normals = np.where(glass[..., None], sample["normal_first"], np.float32((0, 0, 1)))
        write_image(folder / "camera-normals" / f"{name}-cameraNormals.exr", normals)


def write_bop(dataset, folder):
    """Layout of a BOP scene (Hodan et al. 2018): rgb, depth (0.1 mm), mask, mask_visib, scene_camera.json, scene_gt.json
    and scene_gt_info.json. Poses are rigid and in mm; the scale of an object, which BOP has not, is `scale`."""
    folder = Path(folder)
    for part in ("rgb", "depth", "mask", "mask_visib"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    numbers, cameras, poses, infos = {}, {}, {}, {}
    for sample in dataset:
        image, name = str(sample["image"]), sample["name"]
        _copy(dataset, name, ".png", folder / "rgb" / f"{name}.png")
        depth = np.where(sample["depth_first"] > 0, sample["depth_first"], sample["depth_background"])
        _png(folder / "depth" / f"{name}.png", np.clip(depth * 10000.0 + 0.5, 0, 65535).astype(np.uint16))
        cameras[image] = {"cam_K": np.ravel(sample["camera"]["K"]).tolist(), "depth_scale": 0.1}
        poses[image], infos[image] = [], []
        for i, each in enumerate(sample["objects"]):
            whole, seen = each["whole_pixels"], each["visible_pixels"]
            poses[image].append({"obj_id": numbers.setdefault(each["source"], len(numbers) + 1),
                                 "cam_R_m2c": np.ravel(each["rotation"]).tolist(),
                                 "cam_t_m2c": [1000.0 * t for t in each["translation_m"]], "scale": each["scale"]})
            infos[image].append({"bbox_obj": each["whole_box"], "bbox_visib": each["visible_box"],
                                 "px_count_all": whole, "px_count_visib": seen, "visib_fract": seen / max(whole, 1)})
            _png(folder / "mask" / f"{name}_{i:06}.png", _bytes_of(mask_of(each["whole_segmentation"])))
            _png(folder / "mask_visib" / f"{name}_{i:06}.png", _bytes_of(mask_of(each["segmentation"])))
    for file, content in (("scene_camera", cameras), ("scene_gt", poses), ("scene_gt_info", infos)):
        (folder / f"{file}.json").write_text(json.dumps(content), encoding="utf-8")
