"""Results in the frame of the label map: meshes of the stages, displacement fields, markups.

Displacements are since stage 0, the state of the image: tissue that was at x in the image has gone to
x + u(x)."""
import json

import nibabel
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import markups
from problem import Problem

STAGES = ("0", "1", "2", "3", "4", "5", "6a", "6b", "6c", "7", "8", "9")  # that a procedure of dbs may have
INTENT_VECTOR = 1007  # what ITK, ANTs and 3D Slicer take for a displacement field, in LPS
RAS_TO_LPS = np.array([-1.0, -1.0, 1.0])


def read_vtk(path):
    reader = vtk.vtkXMLUnstructuredGridReader() if path.suffix == ".vtu" else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def write_vtk(path, data):
    writer = vtk.vtkXMLUnstructuredGridWriter() if path.suffix == ".vtu" else vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.SetCompressorTypeToZLib()
    if not writer.Write():
        raise Problem(f"{path}: cannot be written: make room on the disk")


def transform(matrix):
    result = vtk.vtkTransform()
    result.SetMatrix(np.asarray(matrix, float).ravel())
    return result


def move(data, matrix):
    """The data set with points and vectors moved by a rigid matrix; named RAS, as 3D Slicer looks for it."""
    mover = vtk.vtkTransformFilter()
    mover.SetInputData(data)
    mover.SetTransform(transform(matrix))
    mover.TransformAllInputVectorsOn()
    mover.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
    for k in range(data.GetPointData().GetNumberOfArrays()):
        array = data.GetPointData().GetArray(k)
        if array.GetNumberOfComponents() == 3:  # read without an attribute type, so it is named one here
            data.GetPointData().SetActiveVectors(array.GetName())
    mover.Update()
    moved = mover.GetOutput()
    space = vtk.vtkStringArray()
    space.SetName("SPACE")
    space.InsertNextValue("RAS")
    moved.GetFieldData().AddArray(space)
    return moved


def field(stage, image, frame):
    """Displacement on the label map's voxels, (i, j, k, 3) RAS in mm; zero outside the brain.

    The mesh is put into voxel coordinates, where the image is a plain lattice whatever its affine."""
    rest = vtk.vtkUnstructuredGrid()
    rest.DeepCopy(stage)
    shift = vtk_to_numpy(stage.GetPointData().GetArray("displacement"))
    position = vtk_to_numpy(rest.GetPoints().GetData())
    to_voxel = np.linalg.inv(image.affine)
    world = frame.to_world(position - shift)
    position[:] = world @ to_voxel[:3, :3].T + to_voxel[:3, 3]
    rest.GetPoints().Modified()
    for k in reversed(range(rest.GetPointData().GetNumberOfArrays())):
        if rest.GetPointData().GetArrayName(k) != "displacement":
            rest.GetPointData().RemoveArray(k)
    # Only the voxels around the brain are probed.
    low = np.maximum(np.floor(position.min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(position.max(axis=0)).astype(int), np.array(image.values.shape) - 1)
    lattice = vtk.vtkImageData()
    lattice.SetOrigin(*map(float, low))
    lattice.SetDimensions(*map(int, high - low + 1))
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(lattice)
    probe.SetSourceData(rest)
    probe.Update()
    found = probe.GetOutput().GetPointData()
    values = vtk_to_numpy(found.GetArray("displacement")).reshape(*(high - low + 1)[::-1], 3)
    inside = vtk_to_numpy(found.GetArray(probe.GetValidPointMaskArrayName()))
    values = frame.turn_to_world(values) * (inside.reshape(values.shape[:3]) > 0)[..., None]
    result = np.zeros((*image.values.shape, 3), np.float32)
    result[tuple(slice(a, b + 1) for a, b in zip(low, high))] = values.transpose(2, 1, 0, 3)
    return result


def write_field(path, displacement, image, title):
    """5-D vector NIfTI, LPS, mm: the form in which ITK, ANTs and 3D Slicer read displacement fields."""
    data = (displacement * RAS_TO_LPS).astype(np.float32)[:, :, :, None, :]
    result = nibabel.Nifti1Image(data, image.affine)
    result.header.set_intent(INTENT_VECTOR)
    result.header.set_xyzt_units("mm")
    result.header["descrip"] = f"displacement LPS mm, {title}"[:79].encode("ascii", "replace")
    nibabel.save(result, path)


def moved_points(stage, points, frame):
    """Landmarks where the tissue has carried them, with their shift said."""
    names = sorted(stage["shift_mm"])
    shifts = frame.turn_to_world([stage["shift_mm"][name] for name in names])
    planned = frame.to_world([points[name] for name in names])
    said = [f"moved by ({x:.2f} {y:.2f} {z:.2f}) mm RAS" for x, y, z in shifts]
    return markups.Markup("Fiducial", f"targets, stage {stage['stage']}", names, planned + shifts, said)


def lead_curves(stage, frame):
    """Side -> the device from its tip outwards."""
    curves = {}
    for side, lead in stage["electrodes"].items():
        nodes = frame.to_world(lead["nodes_mm"])
        device = "cannula" if lead["in_cannula"] and lead["device"] == "cannula" else lead["device"]
        names = ["tip"] + [f"{k}" for k in range(1, len(nodes))]
        curves[side] = markups.Markup("Curve", f"{device}, {side}, stage {stage['stage']}", names, nodes)
    return curves


def write_markups(folder, stages, head, frame):
    points = {name: np.array(position) for name, position in head["landmarks"].items()}
    names = sorted(points)
    markups.write(folder / "planned.landmarks.mrk.json", [
        markups.Markup("Fiducial", "planned", names, frame.to_world([points[name] for name in names]))])
    for side, path in head["trajectories"].items():
        ends = frame.to_world([path["inner_table"], path["target"]])
        markups.write(folder / f"planned.trajectory_{side}.mrk.json", [
            markups.Markup("Line", f"trajectory_{side}", ["entry", "target"], ends)])
    for stage in stages:
        name = f"stage_{stage['stage']}"
        markups.write(folder / f"{name}.targets.mrk.json", [moved_points(stage, points, frame)])
        for side, curve in lead_curves(stage, frame).items():
            markups.write(folder / f"{name}.lead_{side}.mrk.json", [curve])


def chosen(stages, fields):
    """Labels of the stages whose fields are written, and notes on those that were not finished."""
    known = [stage["stage"] for stage in stages]
    if not fields:
        return known[-2:], []
    if fields == "all":
        return known, []
    wanted = [name.strip() for name in fields.split(",")]
    return [name for name in wanted if name in known], [
        f"there is no field of stage {name}, which was not done" for name in wanted if name not in known]


def write(folder, image, frame, fields):
    """Writes folder/image from folder/procedure and folder/head. Returns notes."""
    out, procedure = folder / "image", folder / "procedure"
    out.mkdir()
    head = json.loads((folder / "head" / "head.json").read_text(encoding="utf-8"))
    tables = json.loads((procedure / "stages.json").read_text(encoding="utf-8"))
    stages = [stage for stage in tables["stages"] if (procedure / f"stage_{stage['stage']}.vtu").exists()]
    world_of_head = np.linalg.inv(frame.matrix)
    for path in sorted([*procedure.glob("stage_*.vtu"), *procedure.glob("stage_*.vtp")]):
        write_vtk(out / path.name, move(read_vtk(path), world_of_head))
    names, notes = chosen(stages, fields)
    for name in names:
        title = next(stage["title"] for stage in stages if stage["stage"] == name)
        displacement = field(read_vtk(procedure / f"stage_{name}.vtu"), image, frame)
        write_field(out / f"stage_{name}.displacement.nii.gz", displacement, image, title)
    write_markups(out, stages, head, frame)
    return notes


def write_mark(path, options, frame):
    path.write_text(json.dumps({
        "made_by": "examples/own_head", "labels": options.image, "dictionary": str(options.labels),
        "plan": [str(entry) for entry in options.plan],
        "materials": str(options.materials) if options.materials else None, "edge_mm": options.edge,
        "world_to_head": frame.matrix.tolist()}, indent=1) + "\n", encoding="utf-8")
