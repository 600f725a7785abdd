#pragma once
#include "ReedsSheppWords.h"

namespace semantic_planning {

/** The shortest of the six words of Dubins (1957), which only go forward, between two poses,
 * turning radius 1. */
Word shortestForwardWord(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

}  // namespace semantic_planning
