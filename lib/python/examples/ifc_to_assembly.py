#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An IFC model as an assembly for `cchip clash`, with IfcOpenShell (PyPI: ifcopenshell).

Writes FOLDER/assembly.toml and a mesh for each shape, in metres. A part is an IfcElement with a body, but no opening;
its groups are its class (IfcWall) and its storey. Meshes and placements keep their doubles; a shape that the model
places often is written once. Elements without a name are called by their GlobalId.
Exit codes: 0 written, 2 wrong arguments, or no element with a body."""
import argparse
import json
import multiprocessing
import pathlib
import sys

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", metavar="MODEL.ifc")
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--angle", type=float, default=0.1, help="of a step round a curve, radians (default 0.1)")
    options = parser.parse_args()
    model = ifcopenshell.open(options.model)
    elements = [x for x in model.by_type("IfcElement") if x.Representation and not x.is_a("IfcFeatureElement")]
    settings = ifcopenshell.geom.settings()
    settings.set("mesher-angular-deflection", options.angle)
    files, names, parts = {}, {}, []
    options.folder.mkdir(parents=True, exist_ok=True)
    for shape in ifcopenshell.geom.iterator(settings, model, multiprocessing.cpu_count(), include=elements or None):
        element, mesh = model.by_id(shape.id), shape.geometry
        if not mesh.faces:
            continue
        if mesh.id not in files:
            files[mesh.id] = f"shape{len(files)}.obj"
            v, f = mesh.verts, mesh.faces
            lines = [f"v {v[i]!r} {v[i + 1]!r} {v[i + 2]!r}" for i in range(0, len(v), 3)]
            lines += [f"f {f[i] + 1} {f[i + 1] + 1} {f[i + 2] + 1}" for i in range(0, len(f), 3)]
            (options.folder / files[mesh.id]).write_text("\n".join(lines) + "\n")
        name = element.Name or element.GlobalId
        names[name] = names.get(name, 0) + 1
        columns = shape.transformation.matrix
        storey = ifcopenshell.util.element.get_container(element)
        groups = [element.is_a()] + ([storey.Name] if storey and storey.Name else [])
        parts.append((element.id(), "\n".join([
            "[[part]]", f"name = {json.dumps(name if names[name] == 1 else f'{name} {element.GlobalId}')}",
            f'file = "{files[mesh.id]}"', f"pose = {[columns[4 * j + i] for i in range(4) for j in range(4)]}",
            f"groups = {json.dumps(groups)}", ""])))
    if not parts:
        print(f"{options.model}: no element with a body", file=sys.stderr)
        return 2
    (options.folder / "assembly.toml").write_text(
        "\n".join(['unit = "m"\n'] + [text for _, text in sorted(parts)]), encoding="utf-8")
    print(f"parts={len(parts)} shapes={len(files)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
