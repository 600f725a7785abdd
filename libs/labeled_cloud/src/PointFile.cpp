#include <labeled_cloud/PointFile.h>

#include <labeled_cloud/ScanConverter.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace labeled_cloud {

using strict_files::TextLine;

namespace {

using Words = std::vector<std::string>;

Words wordsOf(const TextLine& line) {
  std::istringstream stream(line.text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/** Where the data begins: behind the line DATA, or if there is none where a header would be over.
 */
std::size_t endOfHeader(const std::string& bytes) {
  constexpr std::size_t kLongestHeader = 1 << 16;
  for (std::size_t line = 0; line < std::min(bytes.size(), kLongestHeader);) {
    const std::size_t end = std::min(bytes.find('\n', line), bytes.size() - 1) + 1;
    if (bytes.compare(line, 5, "DATA ") == 0) return end;
    line = end;
  }
  return std::min(bytes.size(), kLongestHeader);
}

/** The entries of a PCD file's header by their first word. */
class Header {
 public:
  Header(const std::string& bytes, const std::string& name)
      : file(name), dataBegin(endOfHeader(bytes)) {
    const auto all = strict_files::linesOf(bytes.substr(0, dataBegin), file);
    lines = all.size();
    for (const auto& [text, where] : all) {
      const std::size_t space = std::min(text.find(' '), text.size());
      m_entries[text.substr(0, space)] = {text.substr(space), where};
    }
    require({"FIELDS", "POINTS", "DATA"}, file + ": no ");
  }
  void require(const std::vector<const char*>& keys, const std::string& before) const {
    for (const char* key : keys)
      if (!has(key)) throw std::runtime_error(before + key + " in the PCD header");
  }
  bool has(const std::string& key) const { return m_entries.count(key) > 0; }
  const TextLine& at(const std::string& key) const { return m_entries.at(key); }
  /** The words of an entry that has one for each field. */
  Words words(const std::string& key, const char* what, std::size_t fields) const {
    Words words = wordsOf(at(key));
    if (words.size() == fields) return words;
    fail(key,
         std::to_string(words.size()) + " " + what + " for " + std::to_string(fields) + " fields");
  }
  std::vector<std::size_t> wholes(const std::string& key, const char* what, std::size_t fields,
                                  double most) const {
    std::vector<std::size_t> numbers;
    for (const std::string& word : words(key, what, fields)) {
      const double number = strict_files::numbersOf({word, at(key).where}, 1)[0];
      if (!(number >= 0 && number <= most && number == std::floor(number)))
        fail(key, word + ", expected a whole number up to " + strict_files::textOf(most));
      numbers.push_back(static_cast<std::size_t>(number));
    }
    return numbers;
  }
  std::size_t number(const std::string& key) const { return wholes(key, "words", 1, 0x1p40)[0]; }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw std::runtime_error(at(key).where + ": " + what);
  }

  std::string file;
  std::size_t dataBegin, lines = 0;

 private:
  std::map<std::string, TextLine> m_entries;
};

/** Other programs go by WIDTH and HEIGHT. */
void checkGrid(const Header& header, std::size_t points) {
  if (!header.has("WIDTH") || !header.has("HEIGHT")) return;
  const std::size_t rows = header.number("HEIGHT"), columns = header.number("WIDTH");
  if (rows == 0 ? points != 0 : points % rows != 0 || points / rows != columns)
    header.fail("HEIGHT", "a grid of " + std::to_string(columns) + " x " + std::to_string(rows) +
                              " points, and POINTS says " + std::to_string(points));
}

/** A column of the file, or several of one name. */
struct Field {
  std::string name, kind = "F";  ///< floating point, "I": signed, "U": unsigned
  std::size_t size = 1;          ///< of a value: bytes, or a word
  std::size_t count = 1;
  std::size_t before = 0;  ///< in each point: bytes, or words
};

std::vector<Field> fieldsOf(const Header& header, bool isBinary) {
  std::vector<Field> fields;
  for (const std::string& name : wordsOf(header.at("FIELDS"))) fields.push_back({name});
  const std::size_t n = fields.size();
  std::vector<std::size_t> counts(n, 1), sizes = counts;
  Words types(n, "F");
  if (header.has("COUNT")) counts = header.wholes("COUNT", "counts", n, 1e6);
  if (isBinary) {
    header.require({"SIZE", "TYPE"}, header.at("DATA").where + ": binary data, and no ");
    sizes = header.wholes("SIZE", "sizes", n, 8);
    types = header.words("TYPE", "types", n);
  }
  for (std::size_t i = 0, before = 0; i < n; before += sizes[i] * counts[i], ++i)
    fields[i] = {fields[i].name, types[i].substr(0, 1), sizes[i], counts[i], before};
  return fields;
}

const Field& fieldNamed(const std::string& name, const std::vector<Field>& fields,
                        const Header& header) {
  std::string there;
  for (const Field& field : fields) {
    if (field.name == name && field.count == 1) return field;
    if (field.name == name) header.fail("FIELDS", "field '" + name + "' has several values");
    there += " '" + field.name + "'";
  }
  header.fail("FIELDS", "no field '" + name + "' among" + there);
}

template <typename T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

using ReadNumber = double (*)(const char*);

/** How numbers of a field are read. \throw std::runtime_error its type is none. */
ReadNumber readerOf(const Field& field, const Header& header) {
  static const std::map<std::pair<std::string, std::size_t>, ReadNumber> readers = {
      {{"F", 4}, as<float>},         {{"F", 8}, as<double>},        {{"I", 1}, as<std::int8_t>},
      {{"I", 2}, as<std::int16_t>},  {{"I", 4}, as<std::int32_t>},  {{"I", 8}, as<std::int64_t>},
      {{"U", 1}, as<std::uint8_t>},  {{"U", 2}, as<std::uint16_t>}, {{"U", 4}, as<std::uint32_t>},
      {{"U", 8}, as<std::uint64_t>},
  };
  const auto found = readers.find({field.kind, field.size});
  if (found != readers.end()) return found->second;
  header.fail("FIELDS", "field '" + field.name + "' has type " + field.kind + " and size " +
                            std::to_string(field.size) +
                            ", expected F (4, 8), I or U (1, 2, 4, 8)");
}

/** \param rowOf what there is of a point \param valueOf (row, column) \param nameOf a point, for
 * messages */
template <class RowOf, class ValueOf, class NameOf>
PointFile read(std::size_t points, std::size_t columns, RowOf rowOf, ValueOf valueOf,
               NameOf nameOf) {
  PointFile file;
  for (std::size_t i = 0; i < points; ++i) try {
      const auto row = rowOf(i);
      file.points.emplace_back(valueOf(row, 0), valueOf(row, 1), valueOf(row, 2));
      if (columns > 3) file.labels.push_back(rawIdOf(valueOf(row, 3)));
    } catch (const std::exception& e) {
      throw std::runtime_error(nameOf(i) + ": " + e.what());
    }
  return file;
}

/** A line of numbers for each point; missing coordinates are "nan". Values behind those of the
 * fields are left alone. */
PointFile readText(const Header& header, const std::vector<Field>& columns, std::size_t points,
                   const std::string& bytes) {
  const auto lines = strict_files::linesOf(bytes, header.file);
  if (lines.size() - header.lines != points)
    throw std::runtime_error(header.file + ": " + std::to_string(lines.size() - header.lines) +
                             " lines of data for " + std::to_string(points) + " points");
  const auto lineOf = [&](std::size_t i) -> const TextLine& { return lines[header.lines + i]; };
  const auto valueOf = [&](const Words& words, std::size_t k) {
    if (columns[k].before >= words.size()) throw std::invalid_argument("too few values");
    const std::string& word = words[columns[k].before];
    return word == "nan" || word == "-nan" ? NAN : strict_files::numberOf(word);
  };
  return read(
      points, columns.size(), [&](std::size_t i) { return wordsOf(lineOf(i)); }, valueOf,
      [&](std::size_t i) { return lineOf(i).where + ": '" + lineOf(i).text + "'"; });
}

/** Little-endian numbers: all of a point, then all of the next. \param each bytes of a point */
PointFile readBinary(const Header& header, const std::vector<Field>& columns, std::size_t points,
                     const std::string& bytes, std::size_t each) {
  const std::size_t size = bytes.size() - header.dataBegin;
  if (each == 0 || size / each != points || size % each != 0)
    throw std::runtime_error(header.file + ": " + std::to_string(size) + " bytes of data for " +
                             std::to_string(points) + " points of " + std::to_string(each) +
                             " bytes");
  std::vector<ReadNumber> readers;
  for (const Field& column : columns) readers.push_back(readerOf(column, header));
  return read(
      points, columns.size(),
      [&](std::size_t i) { return bytes.data() + header.dataBegin + i * each; },
      [&](const char* row, std::size_t k) { return readers[k](row + columns[k].before); },
      [&](std::size_t i) { return header.file + ": point " + std::to_string(i); });
}

Eigen::Isometry3d viewpoint(const TextLine& line) {
  const auto v = strict_files::numbersOf(line, 7);
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > 0.01)
    throw std::runtime_error(line.where + ": the quaternion's length is not 1");
  return Eigen::Translation3d(v[0], v[1], v[2]) * q.normalized();
}

}  // namespace

PointFile readPointFile(const std::filesystem::path& path, const std::string& labelField) {
  const std::string bytes = strict_files::readText(path);
  const Header header(bytes, path.string());
  const std::string format = header.words("DATA", "words", 1)[0];
  if (format != "ascii" && format != "binary")
    header.fail("DATA", "data '" + format + "', expected ascii or binary");
  const auto fields = fieldsOf(header, format == "binary");
  const std::size_t points = header.number("POINTS");
  checkGrid(header, points);
  std::vector<Field> columns;
  for (const std::string& name : {std::string("x"), std::string("y"), std::string("z"), labelField})
    if (!name.empty()) columns.push_back(fieldNamed(name, fields, header));
  const Field& last = fields.back();
  PointFile file = format == "ascii" ? readText(header, columns, points, bytes)
                                     : readBinary(header, columns, points, bytes,
                                                  last.before + last.size * last.count);
  if (header.has("VIEWPOINT")) file.T_file_sensor = viewpoint(header.at("VIEWPOINT"));
  return file;
}

}  // namespace labeled_cloud
