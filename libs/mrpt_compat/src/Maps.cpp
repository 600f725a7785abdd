#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt_compat/Maps.h>

namespace mrpt_compat {

using mrpt::maps::CColouredPointsMap;
using mrpt::maps::CPointsMap;

namespace {

template <class Buffer>
std::vector<double> numbersOf(const Buffer* buffer) {
  return buffer ? std::vector<double>(buffer->begin(), buffer->end()) : std::vector<double>();
}

#if MSO_MRPT_AT_LEAST(2, 15, 0)

std::vector<double> fieldOf(const CPointsMap& cloud, const std::string& name) {
  if (const auto* field = cloud.getPointsBufferRef_float_field(name)) return numbersOf(field);
  if (const auto* field = cloud.getPointsBufferRef_double_field(name)) return numbersOf(field);
  if (const auto* field = cloud.getPointsBufferRef_uint16_field(name)) return numbersOf(field);
  return numbersOf(cloud.getPointsBufferRef_uint8_field(name));
}

#elif MSO_MRPT_AT_LEAST(2, 14, 0)

std::vector<double> fieldOf(const CPointsMap& cloud, const std::string& name) {
  return name == "t" ? numbersOf(cloud.getPointsBufferRef_timestamp()) : std::vector<double>();
}

#else

std::vector<double> fieldOf(const CPointsMap&, const std::string&) { return {}; }

#endif

std::vector<double> channelOf(const CColouredPointsMap& cloud, std::size_t channel) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    float rgb[3];
    cloud.getPointColor(i, rgb[0], rgb[1], rgb[2]);
    numbers.push_back(rgb[channel]);
  }
  return numbers;
}

}  // namespace

std::vector<double> pointField(const CPointsMap& cloud, const std::string& name) {
  const auto* colored = dynamic_cast<const CColouredPointsMap*>(&cloud);
  if (!colored) return fieldOf(cloud, name);
  const std::size_t channel = name == "color_rf" ? 0 : name == "color_gf" ? 1 : 2;
  return channel < 2 || name == "color_bf" ? channelOf(*colored, channel) : std::vector<double>();
}

}  // namespace mrpt_compat
