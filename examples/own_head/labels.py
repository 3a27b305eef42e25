"""Label maps: the image, the dictionary that says what its values are, and whether the two can make a
head. World coordinates are RAS in mm, as the image's affine gives them."""
import json
import pathlib
from dataclasses import dataclass

import nibabel
import numpy as np
import scipy.ndimage as ndimage

from problem import Problem, point

# Kinds of labels. A tissue label without a side lies on both; the mid-surface parts it.
KINDS = ("background", "cerebrum", "brainstem", "cerebellum", "ventricle", "cistern", "csf")
BACKGROUND, CEREBRUM, BRAINSTEM, CEREBELLUM, VENTRICLE, CISTERN, CSF = range(7)
BUILT_IN = {"freesurfer": pathlib.Path(__file__).parent / "freesurfer.json"}
KEYS = {"value", "from", "to", "name", "kind", "side", "bridge", "landmark"}

LARGEST_HOLE = 1000.0    # mm^3 of background enclosed by labels: smaller ones are sulci closed by voxels
LARGEST_ISLAND = 1000.0  # mm^3 of a side that may lie apart from it: dropped, and said
SMALLEST_PART = {"left": 50e3, "right": 50e3, "brainstem": 3e3, "cerebellum": 10e3}  # mm^3


@dataclass
class LabelMap:
    path: str
    values: np.ndarray   # int32
    affine: np.ndarray   # voxel -> world
    header: object       # of the image

    @property
    def voxel_volume(self):
        return float(abs(np.linalg.det(self.affine[:3, :3])))

    def world(self, index):
        return np.asarray(index, float) @ self.affine[:3, :3].T + self.affine[:3, 3]


@dataclass
class Label:
    first: int
    last: int
    name: str
    kind: int
    side: str = ""
    bridge: bool = False
    landmark: str = ""


@dataclass
class Sorted:
    """A label map in the terms of a head, on the map's voxels."""
    kind: np.ndarray       # index into KINDS
    side: np.ndarray       # -1 left, 1 right, 0 both or neither
    bridge: np.ndarray     # may go on across the midline
    landmarks: dict        # name -> centroid, world


def read_map(path):
    """Reads the image; refuses what is no label map in space."""
    try:
        image = nibabel.load(path)
        data = np.asanyarray(image.dataobj)
    except (OSError, nibabel.filebasedimages.ImageFileError, EOFError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise Problem(f"{path}: cannot be read as an image ({reason}); give a NIfTI file (.nii, "
                      ".nii.gz) or FreeSurfer's .mgz") from error
    if data.ndim != 3:
        raise Problem(f"{path}: is {data.ndim}-D ({' x '.join(map(str, data.shape))}), but a label map "
                      "is 3-D: save the one volume that holds the labels")
    affine = np.asarray(image.affine, float)
    check_affine(path, image, affine)
    if not np.isfinite(data).all() or not np.array_equal(data, np.rint(data)):
        raise Problem(f"{path}: holds values that are no whole numbers, so it is no label map: give the "
                      "segmentation, resampled by nearest neighbour, not the image it was made from")
    if data.min() < -2**31 or data.max() >= 2**31:
        raise Problem(f"{path}: holds values beyond 32 bits, so it is no label map")
    return LabelMap(str(path), data.astype(np.int32), affine, image.header)


def check_affine(path, image, affine):
    scale = np.linalg.norm(affine[:3, :3], axis=0)
    if not np.isfinite(affine).all() or scale.min() <= 0 or (
            abs(np.linalg.det(affine[:3, :3])) < 1e-6 * scale.prod()):
        raise Problem(f"{path}: its affine cannot be inverted (two voxel axes point the same way, or one "
                      "has no length): restore the header from the image the labels were made from")
    if isinstance(image, nibabel.Nifti1Pair):
        if not image.header["qform_code"] and not image.header["sform_code"]:
            raise Problem(f"{path}: has neither qform nor sform, so its frame is unknown: copy the "
                          "header of the image the labels were made from")
        unit = image.header.get_xyzt_units()[0]
        if unit not in ("mm", "unknown"):
            raise Problem(f"{path}: its unit of length is {unit}, not mm: rescale the affine")
    if scale.max() > 6:
        raise Problem(f"{path}: its voxels are {scale.max():.1f} mm wide, too coarse for a brain: give "
                      "voxels of 3 mm or less")


def read_dictionary(name):
    """Labels of a dictionary: a built-in one's name, or a JSON file."""
    path = BUILT_IN.get(str(name), pathlib.Path(name))
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        entries = table["labels"]
    except OSError as error:
        raise Problem(f"--labels {name}: is neither a file nor one of {', '.join(BUILT_IN)}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not JSON with a list 'labels': see examples/own_head/README.md"
                      ) from error
    if not isinstance(entries, list):
        raise Problem(f"{path}: 'labels' is not a list: see examples/own_head/README.md")
    labels = [read_label(path, entry) for entry in entries]
    for i, one in enumerate(labels):
        for other in labels[:i]:
            if one.first <= other.last and other.first <= one.last:
                raise Problem(f"{path}: value {max(one.first, other.first)} stands twice, as "
                              f"'{other.name}' and as '{one.name}': keep one of them")
    return labels


def read_label(path, entry):
    def refuse(what):
        raise Problem(f"{path}: label {json.dumps(entry)}: {what}")

    if not isinstance(entry, dict):
        refuse("write an object with value, name and kind")
    if unknown := set(entry) - KEYS:
        refuse(f"unknown key '{sorted(unknown)[0]}'; known: {', '.join(sorted(KEYS))}")
    first, last = entry.get("value", entry.get("from")), entry.get("value", entry.get("to"))
    if not isinstance(first, int) or not isinstance(last, int) or first > last:
        refuse("needs 'value', or 'from' and 'to', whole numbers")
    if entry.get("kind") not in KINDS:
        refuse(f"'kind' must be one of {', '.join(KINDS)}")
    if entry.get("side", "left") not in ("left", "right"):
        refuse("'side' must be left or right, or be left out")
    return Label(first, last, str(entry.get("name", first)), KINDS.index(entry["kind"]),
                 entry.get("side", ""), bool(entry.get("bridge", False)), entry.get("landmark", ""))


def sort(image, labels, dictionary):
    """Gives each voxel its kind; refuses values that the dictionary does not know."""
    present, index, counts = np.unique(image.values, return_inverse=True, return_counts=True)
    found, unknown = [], []
    for value, count in zip(present, counts):
        match = [k for k, label in enumerate(labels) if label.first <= value <= label.last]
        found.append(match[0] if match else -1)
        if not match and value != 0:
            unknown.append(f"{value} ({count * image.voxel_volume / 1e3:.2g} mL)")
    if unknown:
        more = f" and {len(unknown) - 5} more" if len(unknown) > 5 else ""
        raise Problem(f"{image.path}: holds values that the dictionary {dictionary} does not know: "
                      f"{', '.join(unknown[:5])}{more}: add them to it, with their kind")
    nothing = Label(0, 0, "background", BACKGROUND)
    of_value = [labels[k] if k >= 0 else nothing for k in found]

    def spread(values, kind):
        return np.array(values, kind)[index].reshape(image.values.shape)

    landmarks = {}
    for name in {label.landmark for label in of_value} - {""}:
        mask = spread([label.landmark == name for label in of_value], bool)
        landmarks[name] = image.world(np.mean(np.nonzero(mask), axis=1))
    return Sorted(spread([label.kind for label in of_value], np.uint8),
                  spread([{"left": -1, "right": 1}.get(label.side, 0) for label in of_value], np.int8),
                  spread([label.bridge for label in of_value], bool), landmarks)


def check_parts(image, parts, labels, dictionary):
    """All that a head is made of is there, left is left, and nothing is cut off."""
    masks = {"left": (parts.kind == CEREBRUM) & (parts.side < 0),
             "right": (parts.kind == CEREBRUM) & (parts.side > 0),
             "brainstem": parts.kind == BRAINSTEM, "cerebellum": parts.kind == CEREBELLUM}
    for name, mask in masks.items():
        volume = mask.sum() * image.voxel_volume
        if volume < SMALLEST_PART[name]:
            what = name if name in ("brainstem", "cerebellum") else f"{name} cerebrum"
            raise Problem(f"{image.path}: {'no' if volume == 0 else f'only {volume / 1e3:.1f} mL of'} "
                          f"{what}, for which the dictionary {dictionary} has {values_of(name, labels)}: "
                          "label it, or name its values in a dictionary of your own (--labels)")
    left, right = (image.world(np.mean(np.nonzero(masks[side]), axis=1)) for side in ("left", "right"))
    if left[0] >= right[0]:
        raise Problem(f"{image.path}: the left half lies to the right of the right one (centres "
                      f"{point(left)} and {point(right)} RAS): the header mirrors the image, or the "
                      "dictionary exchanges the sides")
    check_border(image, masks["left"] | masks["right"])


def values_of(name, labels):
    """The values of a part, for a sentence."""
    def belongs(label):
        if name in ("left", "right"):
            return label.kind == CEREBRUM and label.side == name
        return KINDS[label.kind] == name

    mine = [str(label.first) if label.first == label.last else f"{label.first}-{label.last}"
            for label in labels if belongs(label)]
    return "no value" if not mine else "the values " + ", ".join(mine[:4]) + (
        ", ..." if len(mine) > 4 else "")


def check_border(image, cerebrum):
    """The image must hold the whole cerebrum, with a margin of one voxel."""
    edges = np.linalg.norm(image.affine[:3, :3], axis=0)
    for axis, name in enumerate("ijk"):
        for end in (0, -1):
            area = np.take(cerebrum, end, axis=axis).sum() * image.voxel_volume / edges[axis]
            if area > 100.0:
                raise Problem(f"{image.path}: cuts the cerebrum off at the {'first' if end == 0 else 'last'}"
                              f" slice of axis {name} ({area / 100:.0f} cm2): give the whole head")


def check_connected(image, parts):
    """Each half is one piece. Returns what lies apart and may be dropped: a mask, and notes."""
    tissue = (parts.kind == CEREBRUM) | (parts.kind == VENTRICLE)
    apart, notes = np.zeros(parts.kind.shape, bool), []
    for side, sign in (("left", -1), ("right", 1)):
        # Labels of both sides (ventricles, callosum) may be what joins the parts of one.
        pieces, count = ndimage.label(tissue & (parts.side != -sign), np.ones((3, 3, 3)))
        own = (parts.kind == CEREBRUM) & (parts.side == sign)
        sizes = np.bincount(pieces[own], minlength=count + 1) * image.voxel_volume
        main = int(np.argmax(sizes))
        others = [k for k in np.argsort(-sizes) if k not in (0, main) and sizes[k] > 0]
        if others and sizes[others[0]] > LARGEST_ISLAND:
            centre = image.world(np.mean(np.nonzero(pieces == others[0]), axis=1))
            raise Problem(f"{image.path}: the {side} half is in pieces: {sizes[others[0]] / 1e3:.1f} mL "
                          f"around {point(centre)} RAS lie apart from the rest: join them, or give them "
                          "the value of the background")
        if others:
            mask = np.isin(pieces, others) & own
            apart |= mask
            notes.append(f"{side} half: {mask.sum() * image.voxel_volume / 1e3:.2g} mL in "
                         f"{len(others)} crumbs that lie apart are left out")
    return apart, notes


def check_holes(image, parts):
    """Background enclosed by labels; small pockets are filled. Returns notes."""
    labelled = np.pad(parts.kind != BACKGROUND, 1)
    enclosed = ndimage.binary_fill_holes(labelled) & ~labelled
    holes, count = ndimage.label(enclosed[1:-1, 1:-1, 1:-1])
    if not count:
        return []
    sizes = np.bincount(holes.ravel())[1:] * image.voxel_volume
    worst = int(np.argmax(sizes))
    if sizes[worst] > LARGEST_HOLE:
        where = np.nonzero(holes == worst + 1)
        index = [slice(max(0, int(a.min()) - 1), int(a.max()) + 2) for a in where]
        side = parts.side[tuple(index)].astype(int).sum()
        half = "left" if side < 0 else "right"
        raise Problem(f"{image.path}: there is a hole of {sizes[worst] / 1e3:.1f} mL in the {half} half "
                      f"around {point(image.world(np.mean(where, axis=1)))} RAS: give it the value of "
                      "what it is, tissue or ventricle")
    return [f"{count} pockets of background inside ({sizes.sum() / 1e3:.2g} mL) are filled"]
