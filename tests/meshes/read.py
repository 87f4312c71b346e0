#!/usr/bin/env python3
"""Prints what meshio, trimesh and numpy-stl read from each file: number of facets, lowest and highest z."""

import sys

import meshio
import numpy as np
import stl.mesh
import trimesh

for path in sys.argv[1:]:
    mesh = meshio.read(path)
    scene = trimesh.load(path, file_type="stl", force="mesh", process=False)
    corners = stl.mesh.Mesh.from_file(path).vectors
    for facets in (mesh.points[mesh.cells_dict["triangle"]], scene.triangles, corners):
        z = np.asarray(facets, dtype=np.float32)[:, :, 2]
        print(len(facets), z.min(), z.max())
