# SPDX-License-Identifier: Apache-2.0
"""The interface of trimesh.collision.CollisionManager over Scene. trimesh itself is not needed."""
from __future__ import annotations

import copy
from typing import Any

import numpy as np

from ._core import Device, Distance, Object, Result, Scene, _to_object

_EXTERNAL = "__external"  # trimesh's name for the object of in_collision_single()


class ContactData:
    """Two faces in contact."""

    def __init__(self, names: tuple[Any, Any], result: Result, row: int) -> None:
        self.names = set(names)
        self._faces: dict[Any, int] = dict(zip(names, map(int, result.contacts[row])))
        self._result, self._row = result, row

    def index(self, name: Any) -> int:
        """The number of the face of the object with this name."""
        return self._faces[name]

    @property
    def normal(self) -> Any:
        """The unit normal of one of the two faces, (3,) float64: of the mesh that is not in the manager, of the object
        of the manager that was asked, or of the object that was added first. Result.normals() has those of both
        faces."""
        return self._result._normal(self._row)

    @property
    def point(self) -> Any:
        """A point that both faces share, (3,) float64, rounded: the middle of the corners of what they share."""
        return self._result._point(self._row)

    @property
    def depth(self) -> Any:
        """Not offered: raises NotImplementedError."""
        raise NotImplementedError("collisionchip has no penetration depth: it answers which faces touch")


class DistanceData:
    """The nearest points of two objects."""

    def __init__(self, names: tuple[Any, Any], found: Distance) -> None:
        self.names = set(names)
        self.distance: float = found.upper
        self._faces: dict[Any, int] = dict(zip(names, map(int, found.faces)))
        self._points: dict[Any, Any] = dict(zip(names, found.points))

    def index(self, name: Any) -> int:
        """The number of the face of the object with this name on which its nearest point lies."""
        return self._faces[name]

    def point(self, name: Any) -> Any:
        """The nearest point of the object with this name, in the world, (3,) float64."""
        return self._points[name]


class CollisionManager:
    """Named objects with transforms, and which of them collide: the interface of trimesh.collision.CollisionManager.

    A mesh is an Object, a mesh of trimesh, PyVista or Open3D, or anything else with `vertices`, (n, 3) float, and
    `faces`, (m, 3) or (m, 4) integers. All meshes are surfaces, while trimesh makes a solid of one that is convex: here
    an object wholly inside another does not collide with it. Transforms are float64, (4, 4) or (3, 4), and any affine
    map.

    device: who answers, see open_device(); by default the CPU with all cores.
    """

    def __init__(self, device: Device | None = None) -> None:
        self._scene = Scene()
        self._ids: dict[Any, int] = {}
        self._names: dict[int, Any] = {}
        self._ignored: set[frozenset[Any]] = set()
        self._device = device

    def __deepcopy__(self, memo: Any) -> CollisionManager:
        """A manager of its own with the same objects and device."""
        made = CollisionManager(self._device)
        made._scene = copy.copy(self._scene)
        made._ids, made._names, made._ignored = dict(self._ids), dict(self._names), set(self._ignored)
        return made

    def __copy__(self) -> CollisionManager:
        return self.__deepcopy__({})

    def __getstate__(self) -> dict[str, Any]:
        if self._device is not None:
            raise TypeError("a manager with a device of its own cannot be pickled; make one without, and give the "
                            "device where it is loaded")
        return self.__dict__

    def add_object(self, name: Any, mesh: Any, transform: Any = None) -> Object:
        """Adds a mesh, or replaces the one of this name. Returns the Object that was made of the mesh; to add one mesh
        many times, pass this Object.

        name: anything hashable.
        transform: (4, 4) float; None is the identity.

        Raises ValueError and TypeError: as Object and collide().
        """
        made = _to_object(mesh, "mesh")
        number = self._scene.add(made, transform)
        if name in self._ids:
            before = self._ids[name]
            self._scene.remove(before)
            del self._names[before]
        self._ids[name] = number
        self._names[number] = name
        for pair in self._ignored:  # of the object that was replaced
            if name in pair:
                self._scene.set_ignored(*(self._ids[x] for x in pair))
        return made

    def remove_object(self, name: Any) -> None:
        """Takes an object out. Raises ValueError: no object has this name."""
        number = self._id(name)
        self._scene.remove(number)
        del self._ids[name], self._names[number]
        self._ignored = {pair for pair in self._ignored if name not in pair}

    def set_transform(self, name: Any, transform: Any) -> None:
        """Moves an object. transform: (4, 4) float. Raises ValueError: no object has this name, or as collide()."""
        self._scene.set_pose(self._id(name), transform)

    def set_pair_ignored(self, name_a: Any, name_b: Any, ignored: bool = True) -> None:
        """Leaves a pair out of in_collision_internal(), such as two links that a joint connects; or takes it in again.

        Replacing an object keeps its ignored pairs, removing it drops them. trimesh does not have this method.

        Raises ValueError: no object has one of the names, or both are the same.
        """
        self._scene.set_ignored(self._id(name_a), self._id(name_b), ignored)
        pair = frozenset((name_a, name_b))
        if ignored:
            self._ignored.add(pair)
        else:
            self._ignored.discard(pair)

    def in_collision_single(self, mesh: Any, transform: Any = None, return_names: bool = False,
                            return_data: bool = False) -> Any:
        """Does a mesh that is not in the manager collide with any object of it?

        Returns a bool; with return_names the set of names of the objects that it collides with; with return_data a list
        of ContactData, in which the mesh has the name "__external". With one of the two a tuple of two, with both a
        tuple of three.
        """
        scene, made = _alone(mesh, transform)
        if not return_data:
            pairs = self._scene._pairs(scene, first=not return_names, device=self._device)
            return _answer({self._names[number] for number in pairs[:, 1].tolist()}, len(pairs), return_names)
        found = self._scene.contacts(made, transform, contacts="all", device=self._device)
        named = [((_EXTERNAL, self._names[number]), result) for number, result in found]
        return _answer({names[1] for names, _ in named}, len(named), return_names, _data(named))

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Does any object of the manager collide with another one?

        Returns as in_collision_single(); the names are pairs, each in alphabetical order, or in the order of
        add_object() if Python cannot order them.
        """
        if not return_data:
            pairs = self._scene._pairs(first=not return_names, device=self._device)
            return _answer({_in_order((self._names[a], self._names[b])) for a, b in pairs.tolist()}, len(pairs),
                           return_names)
        found = self._scene.contacts(contacts="all", device=self._device)
        named = [((self._names[a], self._names[b]), result) for a, b, result in found]
        return _answer({_in_order(names) for names, _ in named}, len(named), return_names, _data(named))

    def in_collision_other(self, other_manager: CollisionManager, return_names: bool = False,
                           return_data: bool = False) -> Any:
        """Does any object of this manager collide with one of another manager?

        Returns as in_collision_single(); the names are pairs, the one of this manager first. If both managers use a
        name, ContactData.index() of that name is the face of the other manager's object, as in trimesh.
        """
        theirs = other_manager._names
        if not return_data:
            other = copy.copy(self._scene) if other_manager is self else other_manager._scene
            pairs = other._pairs(self._scene, first=not return_names, device=self._device)
            return _answer({(self._names[a], theirs[b]) for a, b in pairs.tolist()}, len(pairs), return_names)
        named = []
        for number, name in self._names.items():
            place = (self._scene.object(number), self._scene.pose(number))
            found = other_manager._scene.contacts(*place, contacts="all", device=self._device)
            named += [((name, theirs[other]), result) for other, result in found]
        return _answer({names for names, _ in named}, len(named), return_names, _data(named))

    def min_distance_single(self, mesh: Any, transform: Any = None, return_name: bool = False,
                            return_data: bool = False) -> Any:
        """How far is a mesh that is not in the manager from the nearest object of it?

        Returns the distance, 0 if they touch or cross and inf if the manager is empty; with return_name the name of
        that object; with return_data a DistanceData, in which the mesh has the name "__external". With one of the two a
        tuple of two, with both a tuple of three; None for the name and the data of an empty manager.
        """
        found = _alone(mesh, transform)[0]._nearest(self._scene)
        names = found and (_EXTERNAL, self._names[found[1]])
        return _least(found, names and names[1], names, return_name, return_data)

    def min_distance_internal(self, name: Any = None, return_names: bool = False, return_data: bool = False) -> Any:
        """How far are the two nearest objects of the manager apart? name: only pairs with this object.

        Returns as min_distance_single(); the names are a pair, as in in_collision_internal(). Ignored pairs are left
        out.
        """
        found = self._scene._nearest(id=0 if name is None else self._id(name))
        names = found and tuple(self._names[number] for number in sorted(found[:2]))
        if found and found[0] > found[1]:
            names = names[::-1]
        return _least(found, names and _in_order(names), names, return_names, return_data)

    def min_distance_other(self, other_manager: CollisionManager, return_names: bool = False,
                           return_data: bool = False) -> Any:
        """How far is the nearest object of this manager from the nearest one of another manager?

        Returns as min_distance_single(); the names are a pair, the one of this manager first.
        """
        found = self._scene._nearest(other_manager._scene)
        names = found and (self._names[found[0]], other_manager._names[found[1]])
        return _least(found, names, names, return_names, return_data)

    def _id(self, name: Any) -> int:
        if name not in self._ids:
            raise ValueError(f"{name} not in collision manager!")
        return self._ids[name]


def scene_to_collision(scene: Any, device: Device | None = None) -> tuple[CollisionManager, dict[Any, Object]]:
    """A manager with all meshes of a trimesh.Scene in their places, by the names of the scene's nodes, and the Object
    of each node. Nodes that show one mesh share its Object.

    device: as CollisionManager.
    """
    if not (hasattr(scene, "graph") and hasattr(scene, "geometry")):
        raise TypeError(f"scene is a {type(scene).__name__}; give a trimesh.Scene, or a mesh to "
                        "CollisionManager.add_object()")
    manager = CollisionManager(device)
    made: dict[Any, Object] = {}
    objects: dict[Any, Object] = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        if geometry not in made:
            try:
                made[geometry] = _to_object(scene.geometry[geometry], "its geometry")
            except (TypeError, ValueError) as error:
                raise type(error)(
                    f"node {node!r}: {error}; or take it out: scene.delete_geometry({geometry!r})") from None
        objects[node] = manager.add_object(node, made[geometry], transform)
    return manager, objects


def _alone(mesh: Any, transform: Any) -> tuple[Scene, Object]:
    """A scene with this mesh only, and its Object."""
    scene, made = Scene(), _to_object(mesh, "mesh")
    scene.add(made, transform)
    return scene, made


def _in_order(names: tuple[Any, Any]) -> tuple[Any, Any]:
    try:
        return (names[1], names[0]) if names[1] < names[0] else names
    except TypeError:
        return names


def _least(found: tuple[int, int, Distance] | None, shown: Any, names: Any, return_names: bool,
           return_data: bool) -> Any:
    """What trimesh returns: a distance, and what was asked for."""
    answer: list[Any] = [np.inf if found is None else found[2].upper]
    if return_names:
        answer.append(shown)
    if return_data:
        answer.append(None if found is None else DistanceData(names, found[2]))
    return tuple(answer) if len(answer) > 1 else answer[0]


def _data(found: list[tuple[tuple[Any, Any], Result]]) -> list[ContactData]:
    return [ContactData(pair, result, row) for pair, result in found for row in range(len(result.contacts))]


def _answer(names: set[Any], count: int, return_names: bool, data: list[ContactData] | None = None) -> Any:
    """What trimesh returns: a bool, and what was asked for."""
    answer: list[Any] = [count > 0]
    if return_names:
        answer.append(names)
    if data is not None:
        answer.append(data)
    return tuple(answer) if len(answer) > 1 else answer[0]
