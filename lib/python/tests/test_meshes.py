# SPDX-License-Identifier: Apache-2.0
"""Meshes of other packages, and what is no mesh: an Object, or a line with the remedy."""
import pathlib
import re

import numpy as np
import pytest

import collisionchip
from collisionchip import CollisionManager, Object, PointCloud, Scene, collide
from shapes import cube, shift

VERTICES, FACES = cube()
CUBE = Object(VERTICES, FACES)
QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])


class Named:
    """What has these attributes, as a mesh of another package."""

    def __init__(self, **attributes):
        self.__dict__.update(attributes)


def pyvista_like(faces):
    return Named(points=VERTICES, faces=np.asarray(faces))


def padded(rows):
    return np.concatenate([[len(row), *row] for row in rows])


MESHES = {
    "object": CUBE,
    "trimesh": Named(vertices=VERTICES, faces=FACES),
    "open3d": Named(vertices=VERTICES, triangles=FACES),
    "pyvista triangles": pyvista_like(padded(FACES)),
    "pyvista quads": pyvista_like(padded(QUADS)),
    "pyvista mixed": pyvista_like(padded([*QUADS[:5], *FACES[-2:]])),
    "pyvista rows": pyvista_like(FACES),
}

QUERIES = {
    "Object": lambda x: Object(x),
    "collide a": lambda x: collide(x, None, CUBE, None),
    "collide b": lambda x: collide(CUBE, None, x, None),
    "collide cloud": lambda x: collide(PointCloud(VERTICES), None, x, None),
    "collide_many a": lambda x: collisionchip.collide_many(x, None, CUBE, None),
    "collide_many b": lambda x: collisionchip.collide_many(CUBE, None, x, None),
    "distance a": lambda x: collisionchip.distance(x, None, CUBE, None),
    "distance b": lambda x: collisionchip.distance(CUBE, None, x, None),
    "solids a": lambda x: collisionchip.solids(x, None, CUBE, None),
    "solids b": lambda x: collisionchip.solids(CUBE, None, x, None),
    "clear_along": lambda x: collisionchip.clear_along(x, None, CUBE, None, (1, 0, 0)),
    "first_contact": lambda x: collisionchip.first_contact(CUBE, None, x, None, (1, 0, 0)),
    "first_met": lambda x: collisionchip.first_met(PointCloud(VERTICES), None, [(x, None)]),
    "Scene.add": lambda x: Scene().add(x),
    "Scene.contacts": lambda x: Scene().contacts(x),
    "Scene.find_contact": lambda x: Scene().find_contact(x, shift(1)),
    "add_object": lambda x: CollisionManager().add_object("x", x),
    "in_collision_single": lambda x: CollisionManager().in_collision_single(x),
    "min_distance_single": lambda x: CollisionManager().min_distance_single(x),
}


@pytest.mark.parametrize("query", QUERIES)
@pytest.mark.parametrize("mesh", MESHES)
def test_every_query_takes_a_mesh(query, mesh):
    QUERIES[query](MESHES[mesh])


@pytest.mark.parametrize("mesh", MESHES)
def test_it_is_the_same_object(mesh):
    made = Object(MESHES[mesh])
    assert made.is_closed and made.vertices.tolist() == VERTICES.tolist()
    assert collisionchip.solids(made, shift(0.5), CUBE, shift(0.5)) == "equal"
    assert collisionchip.solids(MESHES[mesh], None, CUBE, None) == "equal"


NO_MESHES = {
    "None": (None, "NoneType"),
    "text": ("cube.obj", "Object.load"),
    "path": (pathlib.Path("cube.obj"), "Object.load"),
    "tuple": ((VERTICES, FACES), r"Object\(\*"),
    "array": (VERTICES, "Object"),
    "number": (1.5, "Object"),
    "scene": (Named(graph=Named(), geometry={}), "scene_to_collision"),
    "cloud": (PointCloud(VERTICES), "PointCloud"),
    "points": (Named(points=VERTICES), "no faces"),
    "lines": (Named(vertices=VERTICES, entities=[]), "no faces"),
    "grid": (Named(extract_surface=len), "extract_surface"),
    "meshio": (Named(points=VERTICES, get_cells_type=len), "get_cells_type"),
    "several": ({"a": CUBE}, "each of them"),
    "manager": (CollisionManager(), "Object"),
}


@pytest.mark.parametrize("query", QUERIES)
@pytest.mark.parametrize("kind", NO_MESHES)
def test_what_is_no_mesh_gets_a_line_with_the_remedy(query, kind):
    if (query, kind) == ("collide a", "cloud"):
        return  # the other collide()
    mesh, remedy = NO_MESHES[kind]
    with pytest.raises(TypeError) as raised:
        QUERIES[query](mesh)
    text = str(raised.value)
    assert re.search(remedy, text) and "\n" not in text and "incompatible" not in text, text


def test_polygons_and_strips_of_pyvista():
    with pytest.raises(ValueError, match=r"face 0 has 5 corners; give mesh.triangulate\(\)"):
        Object(pyvista_like([5, 0, 1, 2, 3, 4]))
    with pytest.raises(ValueError, match="strips"):
        Object(Named(points=VERTICES, faces=np.zeros(0, int), n_strips=1))
    with pytest.raises(ValueError, match="no faces"):
        Object(pyvista_like(np.zeros(0, int)))


def test_a_column_of_counts_is_refused():
    for rows, number in ((FACES, 3), (QUADS, 4)):
        flat = padded(rows)
        for kind in (np.int64, np.uint8, np.int32):
            with pytest.raises(ValueError, match=rf"column 0 is {number} in all rows.*faces\[:, 1:\]"):
                Object(VERTICES, flat.reshape(len(rows), -1).astype(kind))
        with pytest.raises(ValueError, match=rf"reshape\(-1, {number + 1}\)\[:, 1:\]"):
            Object(VERTICES, flat)
    mixed = QUADS[[np.flatnonzero((QUADS == 3).any(1))[0], 1]]
    fan = np.array([np.roll(row, -list(row).index(3)) if 3 in row else row for row in mixed])
    assert fan[0, 0] == 3 and Object(VERTICES, fan).face_count == 2  # only one of them begins at 3
    with pytest.raises(ValueError, match="numpy.roll"):
        Object(VERTICES, fan[:1])
    assert Object(VERTICES, np.roll(fan[:1], 1, axis=1)).face_count == 1  # the remedy
    assert Object(VERTICES, [[4, 6, 7, 5]]).face_count == 1


def test_ids_are_no_meshes():
    scene = Scene()
    first, second = scene.add(CUBE), scene.add(CUBE, shift(0.5))
    for id in (first, np.int64(first), np.uint8(first)):
        assert [x for x, _ in scene.contacts(id)] == [second]


def test_packages_themselves():
    trimesh = pytest.importorskip("trimesh")
    assert Object(trimesh.creation.box()).face_count == 12
    for mesh, remedy in ((trimesh.Scene(trimesh.creation.box()), r"scene.to_mesh\(\)"),
                         (trimesh.PointCloud(VERTICES), "no faces"),
                         (trimesh.load_path(VERTICES[:3]), "no faces")):
        with pytest.raises(TypeError, match=remedy):
            collide(mesh, None, CUBE, None)
    assert Object(trimesh.Scene(trimesh.creation.box()).to_mesh()).is_closed  # the remedy


def test_pyvista_itself():
    pyvista = pytest.importorskip("pyvista")
    for mesh in (pyvista.Sphere(), pyvista.Cube(), pyvista.Cube().triangulate(), pyvista.Cube() + pyvista.Sphere()):
        assert collide(mesh, None, CUBE, None) or mesh.n_cells == 0
        assert Object(mesh).face_count == mesh.n_cells
    for mesh, remedy in ((pyvista.ImageData(dimensions=(3, 3, 3)), "extract_surface"),
                         (pyvista.MultiBlock([pyvista.Cube()]), "give"),
                         (pyvista.Sphere().cast_to_unstructured_grid(), "extract_surface")):
        with pytest.raises(TypeError, match=remedy):
            CollisionManager().add_object("x", mesh)
    with pytest.raises(ValueError, match="triangulate"):
        Object(pyvista.Polygon(n_sides=7))
    sphere = pyvista.Sphere()
    for wrong in (sphere.faces.reshape(-1, 4), sphere.faces):
        with pytest.raises(ValueError, match="count"):
            Object(sphere.points, wrong)


def test_open3d_itself():
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    for mesh in (open3d.geometry.TriangleMesh.create_box(), open3d.t.geometry.TriangleMesh.create_box()):
        assert Object(mesh).is_closed and collide(mesh, None, CUBE, None)
    box = open3d.geometry.TriangleMesh.create_box()
    with pytest.raises(TypeError, match="no faces"):
        Object(box.sample_points_uniformly(10))


def test_nodes_without_faces_are_named():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene(trimesh.creation.box())
    scene.add_geometry(trimesh.PointCloud(VERTICES), node_name="scan", geom_name="scan of it")
    with pytest.raises(TypeError, match=r"node 'scan': .*no faces.*scene.delete_geometry\('scan of it'\)"):
        collisionchip.scene_to_collision(scene)
    scene.delete_geometry("scan of it")  # the remedy
    assert len(collisionchip.scene_to_collision(scene)[1]) == 1
    scene.add_geometry(trimesh.load_path(VERTICES[:3]), node_name="wire")
    with pytest.raises(TypeError, match="node 'wire': .*no faces"):
        collisionchip.scene_to_collision(scene)
    with pytest.raises(TypeError, match="add_object"):
        collisionchip.scene_to_collision(trimesh.creation.box())
