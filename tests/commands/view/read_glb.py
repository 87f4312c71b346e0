"""Reads a GLB with an independent reader and prints counts and the box; exit status 3 where there is none."""

import sys

try:
    import numpy
    import pygltflib
except ImportError:
    sys.exit(3)

gltf = pygltflib.GLTF2().load(sys.argv[1])
blob = gltf.binary_blob()
kinds = {5126: "<f4", 5125: "<u4", 5121: "u1"}
widths = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def numbers(k):
    accessor = gltf.accessors[k]
    view = gltf.bufferViews[accessor.bufferView]
    start = view.byteOffset + accessor.byteOffset
    width = widths[accessor.type]
    found = numpy.frombuffer(blob, kinds[accessor.componentType], accessor.count * width, start)
    return found.reshape(-1, width)


by_name = {node.name: node for node in gltf.nodes}
terrain = gltf.meshes[by_name["terrain"].mesh].primitives[0]
places, corners = numbers(terrain.attributes.POSITION), numbers(terrain.indices)
print("triangles", len(corners) // 3)
used = places[corners.ravel()]
print("box", *(f"{x:.3f}" for x in [*used.min(axis=0), *used.max(axis=0)]))
(fall,) = gltf.animations or [None]
moving = [] if fall is None else fall.channels
print("rocks", len({channel.target.node for channel in moving}))
for channel in moving[:1]:
    sampler = fall.samplers[channel.sampler]
    times, ends = numbers(sampler.input), numbers(sampler.output)
    assert (numpy.diff(times.ravel()) > 0).all() and len(times) == len(ends)
    print("last", gltf.nodes[channel.target.node].name, f"{times[-1, 0]:.3f}", *(f"{x:.3f}" for x in ends[-1]))
