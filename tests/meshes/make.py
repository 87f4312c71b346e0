#!/usr/bin/env python3
"""Writes the STL files of this folder with the programs that people use.

    pip install meshio trimesh numpy-stl
    python3 tests/meshes/make.py

Every file holds the same four facets (a roof of four triangles with a common top), except where its name
says otherwise. Made with meshio 5.3.5, trimesh 5.2.0, numpy-stl 4.1.1, numpy 2.4.
"""

import pathlib

import meshio
import numpy as np
import stl.mesh
import trimesh

HERE = pathlib.Path(__file__).parent
POINTS = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, 1.5]], dtype=float)
FACETS = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
# Swiss map coordinates: 32-bit numbers cannot hold them, text can.
LV95 = POINTS + [2_600_000.123, 1_200_000.456, 1523.789]


def numpy_stl():
    """The facets as numpy-stl holds them."""
    data = np.zeros(len(FACETS), dtype=stl.mesh.Mesh.dtype)
    data["vectors"] = POINTS[FACETS]
    mesh = stl.mesh.Mesh(data)
    mesh.update_normals()
    return mesh


def cad_text():
    """Upper case, CR LF, a name with blanks and an umlaut in Latin-1, numbers as CAD programs write them."""
    lines = ["SOLID BÖSCHUNG NORD 2"]
    for facet in FACETS:
        lines += ["  FACET NORMAL 0.000000E+000 0.000000E+000 0.000000E+000", "    OUTER LOOP"]
        for x, y, z in POINTS[facet]:
            lines.append(f"      VERTEX {x:.6E} {y:.6E} {z:.6E}")
        lines += ["    ENDLOOP", "  ENDFACET"]
    lines.append("ENDSOLID BÖSCHUNG NORD 2")
    return "\r\n".join(lines).encode("latin-1") + b"\r\n"


def main():
    for name, binary in (("ascii", False), ("binary", True)):
        meshio.write(HERE / f"meshio_{name}.stl", meshio.Mesh(POINTS, [("triangle", FACETS)]), binary=binary)
    meshio.write(HERE / "meshio_ascii_lv95.stl", meshio.Mesh(LV95, [("triangle", FACETS)]), binary=False)
    meshio.write(HERE / "meshio_binary_lv95.stl", meshio.Mesh(LV95, [("triangle", FACETS)]), binary=True)
    flat = np.vstack([FACETS, [[0, 0, 1]]])  # meshio writes nan for the normal of a facet without area
    meshio.write(HERE / "meshio_ascii_flat_facet.stl", meshio.Mesh(POINTS, [("triangle", flat)]), binary=False)

    roof = trimesh.Trimesh(POINTS, FACETS, process=False)
    roof.export(HERE / "trimesh_ascii.stl", file_type="stl_ascii")
    roof.export(HERE / "trimesh_binary.stl", file_type="stl")

    numpy_stl().save(str(HERE / "numpy_stl_ascii.stl"), mode=stl.Mode.ASCII)
    numpy_stl().save(str(HERE / "numpy_stl_binary.stl"), mode=stl.Mode.BINARY)

    text = (HERE / "meshio_ascii.stl").read_bytes()
    (HERE / "cad_upper_crlf_latin1.stl").write_bytes(cad_text())
    (HERE / "two_solids.stl").write_bytes(text + text)
    (HERE / "cr_only.stl").write_bytes(text.replace(b"\n", b"\r"))
    (HERE / "bom.stl").write_bytes(b"\xef\xbb\xbf" + text)
    binary = (HERE / "numpy_stl_binary.stl").read_bytes()
    (HERE / "binary_solid_header.stl").write_bytes(b"solid roof\n".ljust(80) + binary[80:])
    (HERE / "bad_binary_cut_off.stl").write_bytes(binary[:-7])
    (HERE / "bad_ascii_cut_off.stl").write_bytes(text[: len(text) // 2])


if __name__ == "__main__":
    main()
