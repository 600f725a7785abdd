#pragma once
#include <semantic_types/ClassTable.h>

namespace semantic_types {

/** Whatever is drawn where no class was ever seen. */
constexpr Color kColorWithoutClass{150, 150, 150};

/** A class's color, or the gray of those without. \throw std::out_of_range id is not 0..K. */
inline Color colorOf(ClassId id, const ClassTable& classes) {
  return id == kNoClass ? kColorWithoutClass : classes.color(id);
}

}  // namespace semantic_types
