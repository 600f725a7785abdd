#pragma once
#include <cstddef>
#include <string>

namespace dataset2rawlog {

/** Which frames of a sequence to take: FIRST, FIRST + STEP, ... up to LAST, counted from 0. */
struct FrameRange {
  std::size_t first = 0, step = 1, last = static_cast<std::size_t>(-1);

  bool contains(std::size_t frame) const {
    return frame >= first && frame <= last && (frame - first) % step == 0;
  }
};

/** Parses "FIRST:STEP:LAST"; LAST may be left out ("1:2:" is all odd frames).
 * \throw std::invalid_argument naming the text. */
FrameRange parseFrameRange(const std::string& text);

}  // namespace dataset2rawlog
