#!/usr/bin/python3
"""Read frames that ./cloth --vtp FOLDER wrote with VTK, a reader of others, and
check them and those of --ply against the table of the same run, a row a step.
Without python3-vtk9 it says so: "skipped: ..." """
import argparse
import csv
import math
import os
import sys
import xml.etree.ElementTree as xml

try:
    import vtk
except ImportError:
    print("skipped: python3-vtk9 is not installed")
    sys.exit(0)

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("folder")
parser.add_argument("table")
parser.add_argument("--ply", metavar="FOLDER")
options = parser.parse_args()
rows = {float(row["t"]): row for row in csv.DictReader(open(options.table))}


def read(name: str, reader: vtk.vtkAlgorithm | None = None) -> vtk.vtkPolyData:
    """The frame of a file; an error of the reader is an exception."""
    errors = []
    reader = reader or vtk.vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(name))
    reader.SetFileName(name)
    reader.Update()
    assert not errors, f"VTK can't read {name}"
    return reader.GetOutput()


def near(a: float, b: float, scale: float) -> None:
    assert math.isclose(a, b, rel_tol=1e-5, abs_tol=1e-6 * scale), (a, b)


frames = list(xml.parse(f"{options.folder}/frames.pvd").iter("DataSet"))
assert frames, "frames.pvd names no file"
previous = -1.0
for entry in frames:
    t = float(entry.attrib["timestep"])
    assert t > previous, (t, previous)
    previous = t
    row = rows[min(rows, key=lambda time: abs(time - t))]
    near(float(row["t"]), t, 1e-6)
    data = read(f"{options.folder}/{entry.attrib['file']}")
    near(data.GetFieldData().GetArray("TimeValue").GetValue(0), t, 1e-6)
    n, points = data.GetNumberOfPoints(), data.GetPointData()
    assert n == int(row["nodes"]), (n, row["nodes"])
    assert data.GetNumberOfLines() == int(row["edges"])
    assert data.GetNumberOfCells() == (
        data.GetNumberOfLines() + data.GetNumberOfPolys())
    strain = data.GetCellData().GetArray("strain")
    assert strain.GetNumberOfTuples() == data.GetNumberOfCells()
    arrays = {name: points.GetArray(name) for name in
              ("velocity", "force", "mass", "strain", "pinned", "node")}
    for name, array in arrays.items():
        assert array and array.GetNumberOfTuples() == n, name
    mass = [arrays["mass"].GetValue(i) for i in range(n)]
    # Energy and center of mass of the frame, from VTK's numbers.
    kinetic = sum(m * sum(v * v for v in arrays["velocity"].GetTuple(i)) / 2
                  for i, m in enumerate(mass))
    near(kinetic, float(row["kinetic"]), 1)
    for k, axis in enumerate("xyz"):
        center = sum(m * data.GetPoint(i)[k] for i, m in enumerate(mass))
        near(center / sum(mass), float(row["com_" + axis]), 1)
    # l/L - 1 of a line
    assert all(strain.GetValue(c) > -1 for c in range(data.GetNumberOfCells()))
    assert all(arrays["pinned"].GetValue(i) in (0, 1) for i in range(n))
    # Frames for Blender: all points of the start, those of this frame where
    # this frame has them, and its quads.
    if options.ply:
        name = entry.attrib["file"].replace(".vtp", ".ply")
        mesh = read(os.path.join(options.ply, name), vtk.vtkPLYReader())
        points_of_start = mesh.GetNumberOfPoints()
        assert points_of_start == int(rows[min(rows)]["nodes"]), points_of_start
        assert mesh.GetNumberOfPolys() == data.GetNumberOfPolys()
        for i in range(n):
            place = mesh.GetPoint(int(arrays["node"].GetValue(i)))
            for a, b in zip(place, data.GetPoint(i)):
                near(a, b, 1)
print(f"{len(frames)} frames, {data.GetNumberOfPoints()} points, "
      f"{data.GetNumberOfLines()} lines, {data.GetNumberOfPolys()} quads at "
      f"the end")
