"""Semantic octree maps: numpy arrays in, maps, compressed trees and paths out."""
from ._semantic_octree import Abstraction, Follower, Map, Plan, Planner, __version__

__all__ = ["Abstraction", "Follower", "Map", "Plan", "Planner", "__version__"]
