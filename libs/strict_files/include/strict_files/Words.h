#pragma once
#include <strict_files/Memory.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

namespace strict_files {

/** Whether two names of options or of their values are the same. Case, "_" and "-" do not tell them
 * apart, so MRPT's maxRange names max_range. */
bool sameWord(const std::string& a, const std::string& b);

/** What to say of an unknown word: "unknown key 'max_rnge'; did you mean 'max_range'?", or all
 * known ones where none is near (by edit distance).
 * \param kind what it is: "key" */
std::string unknownWord(const std::string& kind, const std::string& word,
                        const std::vector<std::string>& known);

/** "; did you mean 'max_range'?" of a word that is none of the known ones, or nothing where none of
 * them is near. */
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);

/** The text as it can be shown: bytes of control characters, and those that are not UTF-8, are
 * written as "\x1b". Only text without these comes out as it was. */
std::string printable(const std::string& text);

/** A size as people read it: "950 bytes", "1.2 kB", "35 MB" (of 1000 kB each), "2.1 GB". */
std::string sizeText(std::uint64_t bytes);

/** The text without white space around it. */
std::string trimmed(const std::string& text);

/** "a, b, c" */
std::string joined(const std::vector<std::string>& words);

/** What an exception says, without the call stacks that MRPT appends, its own and those of
 * exceptions that it was passed on as. Outputs that are not complete (see OutputFiles.h) have the
 * names that they would have got. */
inline std::string messageOf(const std::exception& e) {
  if (dynamic_cast<const PieceTooLarge*>(&e)) return e.what();
  if (dynamic_cast<const std::bad_alloc*>(&e)) return "more memory is needed than there is";
  if (const auto* error = dynamic_cast<const std::system_error*>(&e);
      error && error->code() == std::errc::resource_unavailable_try_again)
    return "no further thread can be begun: memory, or the number of processes, is at its limit";
  std::string text = e.what();
  const auto keepBetween = [&text](const std::string& begin, const std::string& end) {
    const std::size_t at = text.rfind(begin);
    if (at == std::string::npos) return;
    text.erase(0, at + begin.size());
    text.erase(std::min(text.find(end), text.size()));
  };
  keepBetween("==== MRPT exception ====\n", "\nCall stack backtrace:");
  keepBetween("Message:  ", "\nLocation:");
  const std::string staged = ".unfinished-", letters = "abcdef-";
  for (std::size_t at = 0; (at = text.find(staged, at)) != std::string::npos;)
    text.erase(at, staged.size() + letters.size());
  return text;
}

}  // namespace strict_files
