"""Abstractions and plans are those of the programs."""
import json
import re

import numpy as np
import pytest

import semantic_octree
from support import NAMES, RESOLUTION, map_of_yard, program, yard

ORDER = ["road", ["grass", "unknown"]]


def saved(grown, folder):
    grown.save(folder / "map.semantic")
    return folder / "map.semantic"


def test_the_compressed_map_is_that_of_the_program(tmp_path):
    grown = map_of_yard()
    file = saved(grown, tmp_path)
    weights = tmp_path / "weights.yaml"
    weights.write_text("block_size: 3.2\nname: it\nrelevant: {road: 1, on-foot: {classes: [grass, wall], weight: 0.5}}\n"
                       "irrelevant: {free_space: 0.1}\nalpha: 0.003\n")
    program("semantic-map-compress", file, "--weights", weights, "--output", tmp_path / "out")
    theirs = semantic_octree.Map.load(tmp_path / "out" / "it.semantic")
    terms = {"road": 1, ("grass", "wall"): 0.5, "free_space": -0.1}
    by_file, by_dict = grown.abstraction(weights).map(), grown.abstraction(terms, block_size=3.2).map(alpha=0.003)
    by_text = grown.abstraction({}, relevant="road: 1, grass+wall: 0.5", irrelevant="free_space: 0.1",
                                block_size=3.2, alpha=0.003).map()
    assert theirs == by_file == by_dict == by_text
    assert len(theirs) < 0.8 * len(grown)
    program("semantic-map-compress", file, "--weights", weights, "--leaves", 500, "--output", tmp_path / "few")
    few = grown.abstraction(terms, block_size=3.2)
    assert semantic_octree.Map.load(tmp_path / "few" / "it.semantic") == few.map(leaves=500)
    report = json.loads((tmp_path / "few" / "report.json").read_text())["solutions"][0]
    assert few.alpha == pytest.approx(report["alpha"], rel=1e-9)
    assert few.retention()["road"] == pytest.approx(report["classes"]["road"]["share"], rel=1e-9)


def test_leaves_are_those_of_the_compressed_map_and_fit():
    grown = map_of_yard()
    abstraction = grown.abstraction({"road": 1.0})
    leaves = abstraction.leaves(alpha=0.01)
    assert (leaves == abstraction.map().leaves()).all()
    assert len(abstraction.leaves(leaves=400)) <= 400 < len(grown)
    assert len(abstraction.leaves(alpha=1e-9)) > len(leaves)


def test_an_abstraction_follows_insertions():
    scans = list(yard())
    grown, late = semantic_octree.Map(RESOLUTION, NAMES), semantic_octree.Map(RESOLUTION, NAMES)
    abstraction = grown.abstraction({"road": 1.0})
    for scan in scans:
        grown.insert(*scan)
        late.insert(*scan)
    assert (abstraction.leaves() == late.abstraction({"road": 1.0}).leaves()).all()


def test_an_abstraction_ends_where_another_begins():
    grown = map_of_yard()
    first = grown.abstraction({"road": 1.0})
    second = grown.abstraction({"grass": 1.0})
    with pytest.raises(RuntimeError, match="another abstraction"):
        first.leaves()
    assert len(second.leaves()) > 0


def test_a_plan_is_that_of_the_program(tmp_path):
    grown = map_of_yard()
    file = saved(grown, tmp_path)
    (tmp_path / "order.yaml").write_text("best_to_worst: [road, [grass, unknown]]\nrates: [5]\n")
    (tmp_path / "vehicle.yaml").write_text("footprint: [[-0.3, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.3, 0.3]]\nturning_radius: 0.8\n")
    program("semantic-map-plan", file, "--start=-6,0,0", "--goal=6,-6,-90", "--order", tmp_path / "order.yaml", "--vehicle",
            tmp_path / "vehicle.yaml", "--output", tmp_path / "out")
    theirs = np.genfromtxt(tmp_path / "out" / "path.csv", delimiter=",", names=True, dtype=None, encoding=None)
    vehicle = {"footprint": [[-0.3, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.3, 0.3]], "turning_radius": 0.8}
    start, goal = (-6, 0, 0), (6, -6, -np.pi / 2)
    by_file = grown.plan(start, goal, tmp_path / "order.yaml", tmp_path / "vehicle.yaml")
    by_dict = grown.plan(start, goal, ORDER, vehicle, rates=[5])
    for plan in (by_file, by_dict):
        assert plan and plan.found and plan.status == "found" and plan.reason == ""
        assert len(plan.path) == len(theirs)
        for axis in "xyz":
            assert np.abs(plan.path[axis] - theirs[axis]).max() < 1e-3
    assert plan.length == pytest.approx(plan.path["arc_length"][-1], abs=0.05)
    assert plan.length_per_class["grass"] > 3 and plan.length_per_class["road"] > 3
    assert plan.price >= plan.length + 5 * plan.length_per_class["grass"] - 0.1


def test_a_planner_goes_on_when_the_map_changes():
    grown = map_of_yard()
    planner = grown.planner(ORDER, {"turning_radius": 0.8})
    first = planner.plan((-6, 0, 0), (6, 0, 0))
    assert first and np.abs(first.path["y"]).max() < 2
    wall = np.column_stack([np.full(3000, 1.1), np.random.default_rng(1).uniform(-1.6, 4, 3000), np.tile(np.linspace(0.1, 2, 30), 100)])
    for _ in range(3):
        grown.insert(wall, np.full(3000, 3))
    second = planner.replan((-6, 0, 0))
    assert second and second.path["y"][np.abs(second.path["x"] - 1.1).argmin()] < -1.6
    assert second.length > first.length


def test_why_there_is_no_plan_is_said():
    grown = map_of_yard()
    plan = grown.plan((50, 0, 0), (6, 0, 0), ORDER)
    assert not plan and plan.status == "start off ground" and "(50" in plan.reason
    assert len(plan.path) == 0
    assert grown.plan((-6, 6, 0), (6, 0, 0), ["road"]).status == "start forbidden"
    with pytest.raises(RuntimeError, match="nothing was planned"):
        grown.planner(ORDER).replan((0, 0, 0))


def test_what_is_printed_says_what_it_is():
    grown = map_of_yard()
    said = r"<Map: voxels of 0.25 m, 3 classes \(road, grass, wall\), (\d+) leaves, \d+ kB, x .* to .*, y .*, z .* m>"
    assert int(re.fullmatch(said, repr(grown)).group(1)) == len(grown)
    assert repr(semantic_octree.Map(0.1, list("abcd"))) == "<Map: voxels of 0.1 m, 4 classes (a, b, c, ...), empty>"
    plan = grown.plan((-6, 0, 0), (6, -6, -np.pi / 2), ORDER)
    assert repr(plan).startswith(f"<Plan of {plan.length:.1f} m, price {plan.price:.1f} m: ")
    assert f"{plan.length_per_class['grass']:.1f} m grass" in repr(plan)
    assert repr(grown.plan((50, 0, 0), (6, 0, 0), ORDER)).startswith("<Plan: no path: the start (50, 0)")


def test_a_name_that_is_nearly_a_class_is_asked_about():
    with pytest.raises(ValueError, match="no class 'raod'; did you mean 'road'"):
        map_of_yard().plan((0, 0, 0), (1, 0, 0), ["raod"])
