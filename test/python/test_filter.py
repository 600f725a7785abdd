"""What the map states, and the map against the programs."""
import copy
import pickle

import numpy as np

import semantic_octree
from support import NAMES, RESOLUTION, map_of_yard, program


def test_distributions_are_of_free_space_and_the_classes_in_their_order():
    grown = map_of_yard()
    places = grown.leaves()["center"]
    p, cells = grown.distributions(places), grown.query(places)
    assert np.allclose(p.sum(1), 1) and np.allclose(1 - p[:, 0], cells["occupancy"], atol=2e-4)  # of a grid
    for rank in range(cells["classes"].shape[1]):
        ids = cells["classes"][:, rank]
        named = ids > 0
        assert np.allclose(p[named, ids[named]], cells["probabilities"][named, rank], atol=2e-4)


def test_soft_labels_are_of_the_classes_in_their_order():
    grown = semantic_octree.Map(RESOLUTION, NAMES)
    grown.insert([[1.1, 0.1, 0.1], [0.1, 1.1, 0.1]], np.array([[0.7, 0.2, 0.1], [0, 0, 0]], np.float32))
    cells = grown.query([[1.1, 0.1, 0.1], [0.1, 1.1, 0.1]])
    assert (cells["classes"][:, :3] == [[1, 2, 3], [0, 0, 0]]).all()
    assert np.allclose(cells["probabilities"][0, :2] / cells["probabilities"][0, 2], [7, 2], rtol=0.02)


def write_pcd(file, points, labels, viewpoint):
    """Points in the world's frame."""
    rows = np.zeros(len(points), [("p", "<f4", 3), ("label", "<u4")])
    rows["p"], rows["label"] = points, labels
    x, y, z = viewpoint
    head = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {len(rows)}\n"
            f"HEIGHT 1\nVIEWPOINT {x} {y} {z} 1 0 0 0\nPOINTS {len(rows)}\nDATA binary\n")
    file.write_bytes(head.encode() + rows.tobytes())


def test_the_map_is_that_of_the_program_bit_for_bit(tmp_path):
    random = np.random.default_rng(7)
    table = tmp_path / "classes.yaml"
    table.write_text("no_class: [0]\nclasses:\n" + "".join(f"  - {{id: {i}, name: {name}, color: [{i}, 0, 0], raw: [{i}]}}\n"
                                            for i, name in enumerate(NAMES, 1)))
    grown = semantic_octree.Map(0.2, table)
    files = []
    for number in range(4):
        position = np.array([number, 0.5 * number, 1])  # these numbers are exact, as are differences of them
        points = (random.integers(-2000, 2000, (5000, 3)) / 256).astype(np.float32)
        labels = random.integers(0, 4, 5000)
        files.append(tmp_path / f"{number}.pcd")
        write_pcd(files[-1], points + position, labels, position)
        T = np.eye(4)
        T[:3, 3] = position
        grown.insert(points, labels, T)
    program("dataset2rawlog", "pcd", "--classes", table, *files, "-o", tmp_path / "scans.rawlog")
    program("rawlog2semantic-map", "--classes", table, "--resolution", 0.2, "--output", tmp_path / "map", tmp_path / "scans.rawlog")
    assert semantic_octree.Map.load(tmp_path / "map" / "map.semantic") == grown


def test_maps_come_back_from_files_pickles_and_copies(tmp_path):
    grown = map_of_yard()
    grown.save(tmp_path / "a.semantic")
    others = [semantic_octree.Map.load(str(tmp_path / "a.semantic")), pickle.loads(pickle.dumps(grown)), grown.copy(),
              copy.deepcopy(grown)]
    for other in others:
        assert other == grown and other.classes == NAMES
    grown.insert([[1, 1, 1.0]])
    assert all(other != grown for other in others)
    grown.clear()
    assert len(grown) == 0 and grown.bounds() is None


def test_octomap_files_are_those_of_the_program(tmp_path):
    grown = map_of_yard()
    grown.save(tmp_path / "a.semantic")
    for name in ("a.bt", "a.ot"):
        program("semantic-map-export", tmp_path / "a.semantic", "-o", tmp_path / ("program-" + name))
        grown.to_octomap(tmp_path / name)
        assert (tmp_path / name).read_bytes() == (tmp_path / ("program-" + name)).read_bytes()
    grown.to_octomap(tmp_path / "plain.ot", colors=False)
    assert b"id OcTree\n" in (tmp_path / "plain.ot").read_bytes()
