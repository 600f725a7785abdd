"""Plans over a map, on the road where there is one: 3_plan.py MAP.semantic"""
import sys

from semantic_octree import Map

semantic_map = Map.load(sys.argv[1])
vehicle = {"turning_radius": 0.8, "height": 1.2}  # m
plan = semantic_map.plan((-8, 0, 0), (8, 6, 0), ["road", "grass"], vehicle)  # x, y, heading
if not plan:
    sys.exit(plan.reason)
print(f"{plan.length:.1f} m, by class: {plan.length_per_class}")
print(plan.path[["x", "y", "heading"]][::40])
