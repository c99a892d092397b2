# SPDX-License-Identifier: Apache-2.0
"""Result.show() without a browser: what the page holds, and who is asked to show it."""
import html
import json
import re
import sys
import types
import urllib.parse
import urllib.request
import webbrowser

import numpy as np
import pytest

from collisionchip import Object, Scene, collide

CORNERS = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def at(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.fixture
def three(tmp_path, monkeypatch):
    """A folder that stands for three.js."""
    folder = tmp_path / "three"
    (folder / "examples/js/controls").mkdir(parents=True)
    (folder / "three.min.js").write_text("three();")
    (folder / "examples/js/controls/OrbitControls.js").write_text("controls();")
    monkeypatch.setenv("CCHIP_THREE", str(folder))
    return folder


@pytest.fixture
def opened(monkeypatch):
    """Addresses that a browser was asked to open."""
    found = []
    monkeypatch.setattr(webbrowser, "open", lambda address: found.append(address) or True)
    return found


def data_of(page):
    """What the page draws: the line of JSON with the answer."""
    start = page.index('{"answer":')
    return json.JSONDecoder().raw_decode(page[start:])[0]


def test_page(three, tmp_path, opened):
    cube = Object(CORNERS, FACES)
    result = collide(cube, at(-1), cube, at(0, 1, 1), contacts="all", relation=True)
    path = tmp_path / "view.html"
    view = result.show(path)
    assert opened == [] and path.read_text(encoding="utf-8") == view.page
    assert "<script>three();</script>" in view.page and "<script>controls();</script>" in view.page
    data = data_of(view.page)
    assert data["answer"].startswith("touching: ") and [mesh["name"] for mesh in data["meshes"]] == ["A", "B"]
    assert sorted(row[:2] for row in data["contacts"]) == result.contacts.tolist()
    assert {row[2] for row in data["contacts"]} == {1}
    # both in their places: they lie as far apart as the poses say, around a common middle
    points = [np.array(mesh["vertices"]).reshape(-1, 3) for mesh in data["meshes"]]
    assert (points[1] - points[0] == [1, 1, 1]).all()
    assert (np.concatenate(points).min(0) == -np.concatenate(points).max(0)).all()


def test_curves(three, tmp_path):
    cube = Object(CORNERS, FACES)
    result = collide(cube, None, cube, at(0.5, 0.5, 0.5), contacts="all")
    data = data_of(result.show(tmp_path / "view.html").page)
    ends = np.array(data["curves"]).reshape(-1, 2, 3) + 0.75  # the middle of both
    (points, closed), = result.curves()
    assert closed and len(points) == 6
    assert (ends[:, 0] == points).all() and (ends[:, 1] == np.roll(points, -1, axis=0)).all()
    apart = collide(cube, None, cube, at(3))
    assert data_of(apart.show(tmp_path / "view.html").page)["curves"] == []


def test_browser(three, opened):
    cube = Object(CORNERS, FACES)
    view = collide(cube, None, cube, at(0.5)).show()
    assert len(opened) == 1 and opened[0].startswith("file://")
    path = urllib.request.url2pathname(urllib.parse.urlparse(opened[0]).path)
    with open(path, encoding="utf-8") as file:
        assert file.read() == view.page


def test_notebook(three, opened, monkeypatch):
    shell = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    cube = Object(CORNERS, FACES)
    view = collide(cube, None, cube, at(0.5)).show()
    assert opened == []
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" sandbox="allow-scripts" [^>]*></iframe>', view._repr_html_())
    assert html.unescape(frame[1]) == view.page


def test_scene(three, opened):
    cube = Object(CORNERS, FACES)
    scene = Scene()
    ids = [scene.add(cube, at(x)) for x in (0, 1)]
    (_, _, pair), = scene.contacts(contacts="all")
    (_, hit), = scene.contacts(ids[1])
    (_, outside), = scene.contacts(cube, at(1.5))
    steps = []
    for result in (pair, hit, outside):
        points = [np.array(mesh["vertices"]) for mesh in data_of(result.show().page)["meshes"]]
        steps.append((points[1] - points[0])[0])
    assert steps == [1, -1, -0.5]  # A is the object of the lower id, the one asked about, the one outside


def test_text_in_names(three, tmp_path, opened):
    path = tmp_path / "a<b>&amp;.off"
    path.write_text("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    triangle = Object.load(path)
    page = collide(triangle, None, triangle, None).show().page
    assert "a<b>" not in page and data_of(page)["meshes"][0]["name"] == str(path)


def test_without_three(tmp_path, monkeypatch, opened):
    monkeypatch.setenv("CCHIP_THREE", str(tmp_path))
    cube = Object(CORNERS, FACES)
    with pytest.raises(RuntimeError, match="three.js is missing.*CCHIP_THREE"):
        collide(cube, None, cube, None).show()
    assert opened == []
