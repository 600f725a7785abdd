#pragma once
#include <filesystem>
#include <string>
#include <vector>

/** Messages of a Markdown file, those in the first column of its tables in `backticks`, that no
 * source below these folders says. What changes in them is written as FILE, NAME, X (a capital
 * alone), a number, or `...`; a part between may be of two texts that a source puts together.
 * \return "file:line: part that is not said" */
std::vector<std::string> messagesNobodySays(const std::filesystem::path& markdownFile,
                                            const std::vector<std::filesystem::path>& sources);
