#pragma once
#include <ios>
#include <locale>

namespace strict_files {

/** While one lives, a stream writes and reads numbers as files have them ("0.5", "1000"), whatever
 * std::locale::global() of the program is: it may have decimal commas, and group digits. */
class ClassicNumbers {
 public:
  explicit ClassicNumbers(std::ios& stream)
      : m_stream(stream), m_before(stream.imbue(std::locale::classic())) {}
  ~ClassicNumbers() { m_stream.imbue(m_before); }
  ClassicNumbers(const ClassicNumbers&) = delete;
  ClassicNumbers& operator=(const ClassicNumbers&) = delete;

 private:
  std::ios& m_stream;
  std::locale m_before;
};

}  // namespace strict_files
