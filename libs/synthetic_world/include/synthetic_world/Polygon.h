#pragma once
#include <Eigen/Core>
#include <vector>

namespace synthetic_world {

/** Corners of a convex polygon, counterclockwise. */
using Polygon = std::vector<Eigen::Vector2d>;

/** \throw std::invalid_argument fewer than three corners, or not convex and counterclockwise;
 * `what` names the polygon in the message. */
void requireConvex(const Polygon& polygon, const char* what);

/** The rectangle of this length (along the yaw's direction) and width around a center. */
Polygon rectangle(const Eigen::Vector2d& center, double yaw, double length, double width);

/** The polygon turned by yaw, then moved. */
Polygon placed(const Polygon& polygon, const Eigen::Vector2d& position, double yaw);

/** Distance in meters; 0 for a point inside. */
double distance(const Polygon& polygon, const Eigen::Vector2d& point);

/** Distance in meters; 0 for polygons that touch or overlap. */
double distance(const Polygon& a, const Polygon& b);

}  // namespace synthetic_world
