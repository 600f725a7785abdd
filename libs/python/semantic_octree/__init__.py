"""Semantic octree maps: numpy arrays in, maps, compressed trees and paths out.

    import numpy as np
    from semantic_octree import Map

    grown = Map(0.2, ["road", "grass"])                   # voxels of 0.2 m, classes 1 and 2
    grown.insert(points, labels, T_map_sensor=np.eye(4))  # N x 3, meters, sensor frame; N ids, 0: none
    grown.query([[5, 0, -1.5]])["classes"]                # the three likeliest of each place
    small = grown.abstraction({"road": 1.0}).map(leaves=5000)
    plan = grown.plan((0, 0, 0), (5, 0, 0), order=["road", "grass"])  # x, y (m), heading (radians)
    print(grown, plan, plan.path["x"])
    grown.save("map.semantic")

Begin with help(Map). Errors name the argument, the row, the value and what was expected.
"""
from ._semantic_octree import Abstraction, Follower, Map, Plan, Planner, __version__

__all__ = ["Abstraction", "Follower", "Map", "Plan", "Planner", "__version__"]
