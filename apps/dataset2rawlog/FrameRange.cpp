#include "FrameRange.h"

#include <regex>
#include <stdexcept>

namespace dataset2rawlog {

FrameRange parseFrameRange(const std::string& text) {
  static const std::regex kForm("(\\d{1,9}):(\\d{1,9}):(\\d{1,9})?");
  std::smatch part;
  if (!std::regex_match(text, part, kForm))
    throw std::invalid_argument("--frames " + text +
                                ": expected FIRST:STEP:LAST, for example 0:2:9");
  FrameRange range;
  range.first = std::stoul(part[1]);
  range.step = std::stoul(part[2]);
  if (part[3].matched) range.last = std::stoul(part[3]);
  if (range.step == 0) throw std::invalid_argument("--frames " + text + ": STEP must be 1 or more");
  if (range.last < range.first)
    throw std::invalid_argument("--frames " + text + ": LAST is before FIRST");
  return range;
}

}  // namespace dataset2rawlog
