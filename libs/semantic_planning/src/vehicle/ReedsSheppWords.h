#pragma once
#include <mrpt/math/TPose2D.h>

#include <array>

namespace semantic_planning {

/** A part of a curve of a car whose turning radius is 1. */
struct WordSegment {
  int turn = 0;       ///< 1: left, 0: straight, -1: right
  double length = 0;  ///< negative: backwards; radians on arcs
};
using Word = std::array<WordSegment, 5>;

/** The shortest of the 48 words of Reeds and Shepp (1990) between two poses, turning radius 1. Of
 * words that are as long within rounding, one with fewer segments or cusps, and always the same. */
Word shortestWord(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

/** Length of shortestWord(); the same in both directions, to the bit. */
double shortestWordLength(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

}  // namespace semantic_planning
