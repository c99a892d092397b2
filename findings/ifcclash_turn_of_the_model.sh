#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ifcclash 0.9.0 (PyPI) with ifcopenshell 0.9.0.post1: two walls of one height, 0.1 m deep in each other along 3 m: whether that
# is a clash in mode "intersection" depends on how the whole model is turned.
#
# Walls of 4 x 0.2 x 3 m, parallel, one moved by 1 m along and 0.1 m across; both stand on one floor, so that their bottoms and
# their tops lie in one plane. Tolerance 0.002 m. The model is turned about the vertical axis, the overlap stays as it is. At 0
# and 30 degrees the mode says "pierce" by 0.2, at 10, 45, 60, 90, 200 and 300 nothing, with check_all and without. Mode
# "collision" has the pair at each angle. With the second wall 0.5 m higher up both modes have it at each angle, and then the
# distance without check_all is 0.1, 0.2 or 0.5 by the angle.
# Seen: "0.0 0: pierce 0.2 | pierce 0.2 | collision 0", "0.0 10: nothing | nothing | collision 0" ...
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ifcopenshell==0.9.0.post1 ifcclash==0.9.0 numpy==2.4.6
cd "$folder"
cat > probe.py << 'END'
import logging
import math

import ifcclash.ifcclash
import ifcopenshell
import ifcopenshell.api.context
import ifcopenshell.api.geometry
import ifcopenshell.api.root
import ifcopenshell.api.unit
import numpy


def model(degrees, height):
    result = ifcopenshell.file(schema="IFC4")
    ifcopenshell.api.root.create_entity(result, ifc_class="IfcProject", name="walls")
    ifcopenshell.api.unit.assign_unit(result, length={"is_metric": True, "raw": "METERS"})
    whole = ifcopenshell.api.context.add_context(result, context_type="Model")
    body = ifcopenshell.api.context.add_context(result, context_type="Model", context_identifier="Body",
                                                target_view="MODEL_VIEW", parent=whole)
    angle = math.radians(degrees)
    turn = numpy.eye(4)
    turn[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    beside = numpy.array([[1, 0, 0, 1], [0, 1, 0, 0.1], [0, 0, 1, height], [0, 0, 0, 1.0]])
    for name, place in (("a", turn), ("b", turn @ beside)):
        wall = ifcopenshell.api.root.create_entity(result, ifc_class="IfcWall", name=name)
        shape = ifcopenshell.api.geometry.add_wall_representation(result, context=body, length=4, height=3, thickness=0.2)
        ifcopenshell.api.geometry.assign_representation(result, product=wall, representation=shape)
        ifcopenshell.api.geometry.edit_object_placement(result, product=wall, matrix=place, is_si=True)
    return result


def clash(ifc, **options):
    settings = ifcclash.ifcclash.ClashSettings()
    settings.logger = logging.getLogger("quiet")
    clasher = ifcclash.ifcclash.Clasher(settings)
    clasher.ifcs["model"] = ifc
    clasher.clash_sets = [{"name": "walls", "a": [{"file": "model"}], **options}]
    clasher.clash()
    return [f"{x['type']} {x['distance']:.2g}" for x in clasher.clash_sets[0]["clashes"].values()][:1] or ["nothing"]


for height in (0.0, 0.5):
    for degrees in (0, 10, 30, 45, 60, 90, 200, 300):
        ifc = model(degrees, height)
        print(f"{height} {degrees}:", *clash(ifc, mode="intersection", tolerance=0.002, check_all=True), "|",
              *clash(ifc, mode="intersection", tolerance=0.002, check_all=False), "|",
              *clash(ifc, mode="collision", allow_touching=False))
END
venv/bin/python probe.py | tee seen
diff seen - << 'END'
0.0 0: pierce 0.2 | pierce 0.2 | collision 0
0.0 10: nothing | nothing | collision 0
0.0 30: pierce 0.2 | pierce 0.2 | collision 0
0.0 45: nothing | nothing | collision 0
0.0 60: nothing | nothing | collision 0
0.0 90: nothing | nothing | collision 0
0.0 200: nothing | nothing | collision 0
0.0 300: nothing | nothing | collision 0
0.5 0: protrusion 0.1 | protrusion 0.1 | collision 0
0.5 10: protrusion 0.1 | pierce 0.2 | collision 0
0.5 30: protrusion 0.1 | pierce 0.2 | collision 0
0.5 45: protrusion 0.1 | pierce 0.2 | collision 0
0.5 60: protrusion 0.1 | pierce 0.2 | collision 0
0.5 90: protrusion 0.1 | protrusion 0.1 | collision 0
0.5 200: protrusion 0.1 | pierce 0.2 | collision 0
0.5 300: protrusion 0.1 | protrusion 0.5 | collision 0
END
