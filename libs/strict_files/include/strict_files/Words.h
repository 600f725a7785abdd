#pragma once
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

/** The text without white space around it. */
std::string trimmed(const std::string& text);

/** "a, b, c" */
std::string joined(const std::vector<std::string>& words);

}  // namespace strict_files
