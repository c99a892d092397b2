# SPDX-License-Identifier: Apache-2.0
"""collide_many() and relations of pairs over a Dask cluster: copy this file beside your program, import it, pass a
distributed.Client.

Scheduler and workers need collisionchip and distributed, but not this file: it is sent to them, once to each cluster.
Meshes are (vertices, faces). They are sent once to each worker that needs them; the worker builds the Object once and
keeps the most recent ones. Chunks of a worker that dies are computed again by the others, the results are the same.
docs/develop/scaling.md says when this is the right tool."""
import collections
import hashlib
import pathlib
import threading

import numpy as np
from distributed import as_completed
from distributed.diagnostics.plugin import SchedulerUploadFile, UploadFile

from collisionchip import Object, collide, collide_many as _collide_many, distance, open_device, solids

KEPT = 1024  # objects that a worker keeps
FILE = pathlib.Path(__file__).resolve()
_objects = collections.OrderedDict()
_lock = threading.Lock()
_thread = threading.local()


class _Mesh:
    """What is sent: the arrays and their digest."""

    def __init__(self, mesh):
        vertices, faces = (mesh.vertices, mesh.faces) if hasattr(mesh, "vertices") else mesh
        self.vertices, self.faces = np.ascontiguousarray(vertices, float), np.ascontiguousarray(faces)
        text = repr((self.vertices.shape, self.faces.shape, self.faces.dtype.str)).encode()
        self.digest = hashlib.sha256(text + self.vertices.tobytes() + self.faces.tobytes()).digest()

    def object(self):
        """On a worker: the object, built once."""
        with _lock:  # also while building: another thread most likely waits for the same mesh
            if self.digest not in _objects:
                _objects[self.digest] = Object(self.vertices, self.faces)
            _objects.move_to_end(self.digest)
            while len(_objects) > KEPT:
                _objects.popitem(last=False)
            return _objects[self.digest]


def _device():
    """On a worker: one for each of its threads, which are how Dask uses its cores."""
    if not hasattr(_thread, "device"):
        _thread.device = open_device("cpu", threads=1)
    return _thread.device


def _many(a, b, poses_a, poses_b, options):
    return _collide_many(a.object(), poses_a, b.object(), poses_b, device=_device(), **options)


def _relate(a, b, clearance, inside):
    x, y = a.object(), b.object()
    result = collide(x, None, y, None, device=_device(), contacts="all", relation=True)
    word = None
    if all(part.is_closed and (inside == "odd" or not part.twisted_edge) for part in (x, y)):
        word = solids(x, None, y, None, inside=inside)  # where shells overlap it warns, in the worker's log
    apart = 0.0 if result else distance(x, None, y, None, stop_above=clearance).upper
    in_doubt = word is not None and inside == "odd"
    return result.relation, len(result.contacts), word, apart, tuple(part.shell_overlap if in_doubt else None
                                                                     for part in (x, y))


def _send_this_file(client):
    """To the scheduler and to all workers, also those that start later, which import it by name.

    Client.upload_file() would load it again with each call, and with that a worker would lose its objects."""
    name = f"collide_dask {hashlib.sha256(FILE.read_bytes()).hexdigest()}"
    for plugin in (SchedulerUploadFile(FILE), UploadFile(FILE)):
        plugin.idempotent = True  # a cluster that has a plugin of this name keeps it
        client.register_plugin(plugin, name=name)


def _run(client, meshes, jobs, broadcast, retries):
    """Yields (number of the job, result) as jobs end; jobs: (function, numbers of its meshes, other arguments)."""
    _send_this_file(client)
    meshes = [_Mesh(mesh) for mesh in meshes]
    left = dict(enumerate(jobs))
    for _ in range(retries + 1):
        # without hash=True a second attempt gets keys of its own, not those that a dead worker took with it
        sent = client.scatter(meshes, broadcast=broadcast, hash=False)
        futures = {client.submit(function, *(sent[n] for n in of), *arguments, pure=False): number
                   for number, (function, of, arguments) in left.items()}
        for future in as_completed(futures):
            if future.status == "error" and type(future.exception()).__name__ != "KilledWorker":
                future.result()  # raises
            if future.status == "finished":
                try:
                    result = future.result()
                # gone between the two lines, with its worker: what a function raises is an error above
                except Exception:
                    continue
                left.pop(futures[future])
                yield futures[future], result
            future.release()
        if not left:
            return
    raise RuntimeError(f"{len(left)} of {len(jobs)} jobs were lost {retries + 1} times with their workers")


def _part(poses, chunk):
    """The poses of a chunk, if there is one for each query."""
    return poses[chunk] if poses is not None and np.ndim(poses) == 3 else poses


def collide_many(client, a, poses_a, b, poses_b, *, contacts=False, chunk=16384, retries=3, **options):
    """As collisionchip.collide_many(), with meshes for objects; the results are in the order of the poses.

    chunk: queries of one task. retries: attempts after all workers with a chunk's meshes have died."""
    if options.get("relation"):
        raise ValueError("relation: collide_many() over Dask tells hits and contacts only; use relate_pairs()")
    poses_a, poses_b = (None if poses is None else np.asarray(poses, float) for poses in (poses_a, poses_b))
    counts = {len(poses) for poses in (poses_a, poses_b) if poses is not None and poses.ndim == 3}
    if len(counts) > 1:
        raise ValueError(f"poses: as many of A as of B, not {' and '.join(map(str, sorted(counts)))}")
    count = counts.pop() if counts else 1
    starts = range(0, count, chunk)
    jobs = [(_many, (0, 1), (_part(poses_a, slice(first, first + chunk)), _part(poses_b, slice(first, first + chunk)),
                             {"contacts": contacts, **options})) for first in starts]
    found = dict(_run(client, [a, b], jobs, True, retries))
    if not contacts:
        return np.concatenate([np.zeros(0, bool), *(found[i] for i in range(len(jobs)))])
    for i, first in enumerate(starts):
        found[i][1][:, 0] += np.uint32(first)
    hits, pairs = zip(*(found[i] for i in range(len(jobs)))) if jobs else ((), ())
    return np.concatenate([np.zeros(0, bool), *hits]), np.concatenate([np.zeros((0, 3), np.uint32), *pairs])


def relate_pairs(client, meshes, pairs, *, clearance=0.0, inside="odd", retries=3):
    """Yields (a, b, relation, contacts, solids, distance, overlaps) for pairs of meshes in place, as each is done; a
    and b are numbers of meshes.

    relation: of the surfaces; contacts: how many face pairs touch; solids: the word of collisionchip.solids(), None
    unless both meshes are closed and, with inside="nonzero", their faces all the same way round; distance: of the
    surfaces, inf if it is greater than clearance; overlaps: Object.shell_overlap of both, None if the word does not
    depend on it. A mesh goes only to workers that need it."""
    pairs = list(pairs)
    for number, result in _run(client, meshes, [(_relate, pair, (clearance, inside)) for pair in pairs],
                               False, retries):
        yield (*pairs[number], *result)


# A scheduler or worker in this process loads its copy of this file in the place of this module. What the module had
# stays: tasks name its functions, pickle sends only the very same ones, and the copy of the file is deleted later.
_digest = hashlib.sha256(FILE.read_bytes()).digest()
if globals().get("_first", {}).get("_digest") == _digest:
    globals().update(_first)
else:
    _first = {name: value for name, value in globals().items() if name != "_first"}
