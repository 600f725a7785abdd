#pragma once
#include <labeled_cloud/PointFile.h>
#include <strict_files/TextFile.h>

#include <string_view>

namespace labeled_cloud {

constexpr std::size_t kLongestHeader = 1 << 16;  ///< bytes that are searched for its end

/** A column of a file of points, or several of one name. */
struct PointField {
  std::string name;
  char kind = 'F';       ///< 'F' floating point, 'I' signed, 'U' unsigned
  std::size_t size = 4;  ///< bytes of a value
  std::size_t count = 1;
};

/** What a header says of the points behind it. */
struct PointFields {
  std::vector<PointField> fields;
  std::size_t points = 0;
  std::string file;
  std::string where;       ///< of the list of fields, for messages
  std::string labelField;  ///< empty: none
};

/** A line of numbers for each point. Values behind those of the fields are left alone.
 * \param first the first line behind the header; there is one for each point
 * \throw std::runtime_error naming line or field. */
PointFile readTextPoints(const PointFields& fields,
                         const std::vector<strict_files::TextLine>& lines, std::size_t first);

/** Little-endian numbers: all of a point, then all of the next; or `byField`, all of a field, then
 * all of the next. \param bytes at least as many as the points need
 * \throw std::runtime_error naming point or field. */
PointFile readBinaryPoints(const PointFields& fields, std::string_view bytes, bool byField);

/** Bytes of one point. */
std::size_t bytesOfPoint(const PointFields& fields);

PointFile parsePcd(const std::string& bytes, const std::string& name, const std::string& label);
PointFile parsePly(const std::string& bytes, const std::string& name, const std::string& label);

}  // namespace labeled_cloud
