#!/usr/bin/env python3
"""Fails where a source includes against the arrows of the architecture, or where headers include each other in a circle.

  includes_go_one_way.py ROOT

Plugin may include Filters, and Filters may include Kernels; never the other way. Within Kernels/ and Filters/ a room may
include those that LAYERS lists before it, and its own.
"""
import pathlib
import re
import sys

# Rooms from the bottom up: one may include what stands on its line or above it.
LAYERS = {
    "Kernels": [
        ["Device"],
        ["Numerics"],
        ["Medium", "PhaseFunction", "Lights", "Light"],
        ["Distribution"],
        ["LightPropagation"],
        ["DiscreteOrdinates", "Refraction"],
        ["Photons"],
        ["LatticeBoltzmann", "Reconstruction", "Viewing"],
        ["Comparison"],
    ],
    "Kernels/LightPropagation": [
        ["."],  # settings, what all of them read
        ["Angular"],
        ["Sweep", "Problem"],
        ["Scattering", "Uncollided", "Diffusion", "PlaneParallel"],
        ["Emission", "ThickVoxels", "CoarseDiffusion"],
        ["Conservative", "Published"],
        ["Accuracy"],
    ],
    "Kernels/Viewing": [
        ["Scene"],
        ["Samples"],
        ["Sources", "Backdrop"],
        ["Rays"],
        ["."],  # the ray caster, made of all of them
        ["Blocks"],
    ],
    "Filters": [
        ["Common"],
        ["Pieces"],
        ["IO", "Scene", "Propagation", "Photons", "Viewing"],
    ],
}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
SUFFIXES = {".h", ".cxx", ".cl"}


def included(root, top, file):
    """Files of this project that a file includes: paths are from the top folder on, or beside it."""
    for name in INCLUDE.findall(file.read_text()):
        for folder in (root / top, root / "Kernels", root / "Filters", file.parent):
            if (folder / name).is_file():
                yield (folder / name).resolve().relative_to(root)
                break
        else:
            beside = [f for f in (root / "Filters").rglob(pathlib.Path(name).name)] if "/" not in name else []
            if beside:  # classes are included by their name alone, as VTK does
                yield beside[0].resolve().relative_to(root)


def room_of(path, layer):
    """Level and name of the room in which a path lies, below the folder of LAYERS; None if not below it."""
    inside = path.relative_to(layer).parts if path.is_relative_to(layer) else ()
    if not inside:
        return None
    room = inside[0] if len(inside) > 1 else "."
    for level, rooms in enumerate(LAYERS[layer]):
        if room in rooms:
            return level, room
    return None


def faults_of(path, other):
    if path.parts[0] == "Kernels" and other.parts[0] != "Kernels":
        yield "Kernels know nothing of it"
    if path.parts[0] == "Filters" and other.parts[0] not in ("Kernels", "Filters"):
        yield "Filters know nothing of it"
    for layer in LAYERS:
        ours, theirs = room_of(path, layer), room_of(other, layer)
        if ours and theirs and ours[1] != theirs[1]:
            if theirs[0] > ours[0]:
                yield "%s is above %s" % (theirs[1], ours[1])


def circles(edges):
    """Circles of includes, each once."""
    state, stack = {}, []

    def visit(node):
        state[node] = "open"
        stack.append(node)
        for other in edges.get(node, ()):
            if state.get(other) == "open":
                yield stack[stack.index(other):] + [other]
            elif other not in state:
                yield from visit(other)
        stack.pop()
        state[node] = "done"

    for node in sorted(edges):
        if node not in state:
            yield from visit(node)


def main(root):
    root = pathlib.Path(root).resolve()
    faults, edges = [], {}
    for top in ("Kernels", "Filters", "Plugin"):
        for file in sorted(f for f in (root / top).rglob("*") if f.suffix in SUFFIXES):
            path = file.relative_to(root)
            edges[path] = list(included(root, top, file))
            faults += ["%s: %s has no room of that name in LAYERS" % (path, layer) for layer in LAYERS
                       if path.parent.is_relative_to(layer) and path.parent != pathlib.Path(layer)
                       and room_of(path, layer) is None]
            faults += ["%s includes %s: %s" % (path, other, why) for other in edges[path]
                       for why in faults_of(path, other)]
    faults += ["a circle: " + " includes ".join(map(str, circle)) for circle in circles(edges)]
    if not edges:
        sys.exit("There are no sources under %s" % root)
    if faults:
        sys.exit("\n".join(faults))
    print("%d files include %d, all one way" % (len(edges), sum(map(len, edges.values()))))


main(*sys.argv[1:])
