#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace strict_files {

/** Whether two names of options or of their values are the same: case, "_" and "-" do not tell them
 * apart, so that MRPT's way of writing (maxRange) names max_range. */
bool sameWord(const std::string& a, const std::string& b);

/** What to say of a word that is none of the known ones: "unknown key 'max_rnge'; did you mean
 * 'max_range'?", or all that are known where none is near (by edit distance).
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

}  // namespace strict_files
