#include "ros2/Messages.h"

namespace ros2 {

Time timeOf(Stamp stamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  const Stamp seconds = stamp / kSecond - (stamp % kSecond < 0);
  return {static_cast<std::int32_t>(seconds),
          static_cast<std::uint32_t>(stamp - seconds * kSecond)};
}

Header headerOf(Stamp stamp, const std::string& frame) { return {timeOf(stamp), textOf(frame)}; }

}  // namespace ros2
