# SPDX-License-Identifier: Apache-2.0
"""Meshes of other packages as arrays. None of these packages is imported: a mesh is known by its attributes."""
from __future__ import annotations

import os
from typing import Any

import numpy as np


def _kind(mesh: Any) -> str:
    return f"{type(mesh).__module__.partition('.')[0]}.{type(mesh).__qualname__}" if type(
        mesh).__module__ != "builtins" else type(mesh).__qualname__


def _has(mesh: Any, *names: str) -> bool:
    return all(getattr(mesh, name, None) is not None for name in names)


def _unpadded(padded: Any, name: str) -> Any:
    """Faces of VTK, [count, vertex, ..., count, ...]: triangles and quads, a triangle among quads with its last vertex
    twice."""
    padded = np.asarray(padded)
    rows = []
    at = 0
    while at < len(padded):
        count = int(padded[at])
        if count not in (3, 4):
            raise ValueError(f"{name}: face {len(rows)} has {count} corners; give mesh.triangulate()")
        rows.append(padded[at + 1:at + 1 + count])
        at += 1 + count
    quads = any(len(row) == 4 for row in rows)
    return np.array([[*row, row[-1]] if quads and len(row) == 3 else row for row in rows], dtype=np.int64)


def _of_pyvista(mesh: Any, name: str) -> tuple[Any, Any]:
    if getattr(mesh, "n_strips", 0):
        raise ValueError(f"{name} has strips of triangles; give mesh.triangulate()")
    faces = np.asarray(mesh.faces)
    if faces.ndim != 1:
        return mesh.points, faces
    for corners in (3, 4):  # one kind only: without a loop
        if len(faces) and len(faces) % (corners + 1) == 0 and (faces[::corners + 1] == corners).all():
            return mesh.points, faces.reshape(-1, corners + 1)[:, 1:]
    return mesh.points, _unpadded(faces, name)


def arrays_of(mesh: Any, name: str) -> tuple[Any, Any]:
    """Vertices and faces of a mesh of trimesh, PyVista or Open3D, or of anything with `vertices` and `faces`.

    Raises TypeError: it is no mesh; ValueError: it is one whose faces cannot be used. The message is a line with the
    remedy."""
    if isinstance(mesh, (str, bytes, os.PathLike)):
        raise TypeError(f"{name} is a path or a text; give Object.load({os.fspath(mesh)!r})")
    if _has(mesh, "graph", "geometry"):
        raise TypeError(f"{name} is a {_kind(mesh)} of several meshes; give scene.to_mesh(), all of them in their "
                        "places as one, "
                        "or use scene_to_collision(scene)")
    if _has(mesh, "vertices", "faces"):
        return np.asarray(mesh.vertices), np.asarray(mesh.faces)
    if _has(mesh, "vertices", "triangles"):  # Open3D
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if _has(mesh, "vertex", "triangle"):  # Open3D's tensors, maybe on a GPU
        mesh = mesh.cpu() if hasattr(mesh, "cpu") else mesh
        if "positions" in mesh.vertex and "indices" in mesh.triangle:
            return mesh.vertex.positions.numpy(), mesh.triangle.indices.numpy()
        raise ValueError(f"{name} is a {_kind(mesh)} without triangles; give one that has them")
    if _has(mesh, "points", "faces"):
        return _of_pyvista(mesh, name)
    if hasattr(mesh, "extract_surface"):  # PyVista's grids
        raise TypeError(f"{name} is a {_kind(mesh)}, which has no faces of its own; give "
                        "mesh.extract_surface().triangulate()")
    if _has(mesh, "points", "get_cells_type"):  # meshio
        raise TypeError(f"{name} is a {_kind(mesh)}; give Object(mesh.points, mesh.get_cells_type('triangle'))")
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        raise TypeError(f"{name} is a {_kind(mesh)}; give an Object: Object(*{name}) if these are vertices and faces")
    if hasattr(mesh, "keys") and hasattr(mesh, "values"):  # PyVista's MultiBlock, Open3D's models
        raise TypeError(f"{name} is a {_kind(mesh)} of several meshes; give each of them by itself")
    if _kind(mesh).endswith("PointCloud") or (_has(mesh, "points") and not _has(mesh, "faces")) or \
            (_has(mesh, "vertices") and not _has(mesh, "entities")):
        raise TypeError(f"{name} is a {_kind(mesh)}, which has points but no faces; give a mesh, or collide() a "
                        "PointCloud of its points, first")
    if _has(mesh, "vertices", "entities"):  # Path of trimesh
        raise TypeError(f"{name} is a {_kind(mesh)} of lines, which have no faces; give a mesh")
    raise TypeError(f"{name} is a {_kind(mesh)}; give an Object: Object(vertices, faces), Object.load(path), or a mesh "
                    "of trimesh, PyVista or Open3D")
