"""Leaves, rays, readers of changes, and threads."""
import threading
import time

import numpy as np

import semantic_octree
from support import NAMES, RESOLUTION, map_of_yard, pose, voxels_of, yard


def test_leaves_say_what_queries_of_their_voxels_say():
    grown = map_of_yard()
    leaves = grown.leaves()
    assert len(leaves) == len(grown)
    centers, owners = voxels_of(leaves)
    cells = grown.query(centers)
    assert cells["known"].all()
    for field in ("occupancy", "classes", "probabilities"):
        assert (cells[field] == leaves[field][owners]).all()
    low, high = grown.bounds()
    assert (centers.min(0) - RESOLUTION / 2 == low).all() and (centers.max(0) + RESOLUTION / 2 == high).all()


def test_leaves_in_a_box_are_those_whose_voxels_are():
    grown = map_of_yard()
    leaves = grown.leaves()
    low, high = np.array([-1.1, -2.2, 0]), np.array([3.3, 1.7, 1.2])
    first, last = (np.floor(corner / RESOLUTION) * RESOLUTION for corner in (low, high))
    half = leaves["size"][:, None] / 2
    inside = (leaves["center"] + half > first) & (leaves["center"] - half < last + RESOLUTION)
    assert (grown.leaves(low, high) == leaves[inside.all(1)]).all()
    assert (grown.leaves([-1e9] * 3, [1e9] * 3) == leaves).all()


def test_rays_end_where_they_enter_the_first_occupied_voxel():
    grown = map_of_yard()
    leaves = grown.leaves()
    centers, owners = voxels_of(leaves[leaves["occupancy"] > 0.5])
    random = np.random.default_rng(3)
    origins = np.column_stack([random.uniform(-5, 5, (300, 2)), random.uniform(1, 2, 300)])
    origins = origins.astype(np.float32).astype(float)
    directions = random.normal(size=(300, 3))
    hits = grown.cast_rays(origins, directions)
    assert 50 < hits["hit"].sum() < 300
    for origin, direction, hit in zip(origins, directions / np.linalg.norm(directions, axis=1)[:, None], hits):
        borders = np.stack([centers - RESOLUTION / 2 - origin, centers + RESOLUTION / 2 - origin]) / direction
        enters, leaves_at = borders.min(0).max(1), borders.max(0).min(1)
        crossed = (leaves_at - enters > 1e-3) & (enters > 0)  # what is grazed may be missed
        if not crossed.any():
            continue
        first = enters[crossed].min()
        grazed = (abs(leaves_at - enters) <= 1e-3) & (enters > 0) & (enters < first)
        if grazed.any():
            continue
        assert hit["hit"]
        assert (hit["center"] == centers[crossed][enters[crossed].argmin()]).all()
        assert np.isclose(hit["distance"], np.linalg.norm(hit["center"] - origin))
    cells = grown.query(hits["center"][hits["hit"]])
    assert (cells["classes"] == hits["classes"][hits["hit"]]).all()
    near = grown.cast_rays(origins, directions, max_range=2.0)
    assert (near["hit"] == (hits["hit"] & (hits["distance"] <= 2.0))).all()
    inf = grown.cast_rays(origins, directions, max_range=np.inf)
    assert (inf == hits).all()


def test_a_reader_is_told_the_tiles_of_all_that_changed():
    scans = list(yard())
    grown = semantic_octree.Map(RESOLUTION, NAMES)
    reader, late = grown.follow(), grown.follow()
    everything, tiles = reader.tiles()
    assert everything and len(tiles) == 0
    for number, scan in enumerate(scans):
        before = grown.copy()
        grown.insert(*scan)
        everything, tiles = reader.tiles()
        assert not everything or number == 0
        centers, _ = voxels_of(grown.leaves())
        changed = before.query(centers) != grown.query(centers)
        assert changed.any()
        told = {tuple(tile) for tile in tiles}
        places = np.floor(centers[changed] / reader.tile_size) * reader.tile_size
        assert {tuple(place) for place in places} <= told
        assert len(reader.tiles()[1]) == 0
    everything, tiles = late.tiles()
    places = np.floor(voxels_of(grown.leaves())[0] / late.tile_size) * late.tile_size
    assert everything and {tuple(tile) for tile in tiles} == {tuple(place) for place in places}
    grown.clear()
    assert reader.tiles()[0]


def test_a_reader_keeps_its_map():
    reader = map_of_yard().follow()
    assert reader.tiles()[0]


def test_other_threads_run_while_a_scan_is_inserted():
    points = np.random.default_rng(0).uniform(-15, 15, (400_000, 3)).astype(np.float32)
    grown = semantic_octree.Map(0.1, NAMES)
    ended, duration = threading.Event(), []

    def insert():
        begin = time.perf_counter()
        grown.insert(points)
        duration.append(time.perf_counter() - begin)
        ended.set()

    thread = threading.Thread(target=insert)
    longest, last = 0, time.perf_counter()
    thread.start()
    while not ended.is_set():
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    longest = max(longest, time.perf_counter() - last)
    thread.join()
    assert longest < duration[0] / 2


def test_threads_share_a_map():
    alone = semantic_octree.Map(RESOLUTION, NAMES)
    shared = semantic_octree.Map(RESOLUTION, NAMES)
    reader, failures, ended = shared.follow(), [], threading.Event()

    def ask():
        try:
            while not ended.is_set():
                shared.query(np.zeros((1000, 3)))
                reader.tiles()
                len(shared.leaves())
                shared.copy().clear()
                shared.abstraction({"road": 1.0}).leaves(alpha=0.01)
        except Exception as error:  # another thread may have given it another abstraction
            if "another abstraction" not in str(error):
                failures.append(error)

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    for number in range(20):
        for points, labels, T in yard(number):
            shared.insert(points, labels, T)
            alone.insert(points, labels, T)
    ended.set()
    for thread in threads:
        thread.join()
    assert not failures
    shared.insert([[1, 1, 1]]), alone.insert([[1, 1, 1]])
    assert shared == alone


def test_time_passes(tmp_path):
    table = tmp_path / "classes.yaml"
    table.write_text("classes:\n  - {id: 1, name: person, color: [1, 2, 3], half_life: 2}\n")
    grown = semantic_octree.Map(RESOLUTION, table)
    grown.insert([[1.1, 0.1, 0.1]], [1], pose(0, 0, 0))
    fresh = grown.query([[1.1, 0.1, 0.1]])["occupancy"][0]
    grown.age(2)
    old = grown.query([[1.1, 0.1, 0.1]])["occupancy"][0]
    assert abs(np.log(old / (1 - old)) / np.log(fresh / (1 - fresh)) - 0.5) < 0.02
    later = grown.copy()
    grown.age(3)
    later.insert(np.zeros((0, 3)), seconds=3)
    assert later == grown
