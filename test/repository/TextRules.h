#pragma once
#include <filesystem>
#include <string>
#include <vector>

/** Each returns its findings as "file:line: what is wrong", with paths relative to `root`. */
std::vector<std::string> linesWithTrailingSpace(const std::filesystem::path& root);

/** At the end of a line or, what no editor shows, within it. */
std::vector<std::string> linesWithCarriageReturn(const std::filesystem::path& root);

/** Paths that exist on somebody's machine only, and names of package servers. */
std::vector<std::string> linesTiedToAMachine(const std::filesystem::path& root);

/** C++ files with more lines than that. */
std::vector<std::string> filesLongerThan(std::size_t maxLines, const std::filesystem::path& root);

/** Links of a Markdown file to files that do not exist. */
std::vector<std::string> brokenLinks(const std::filesystem::path& markdownFile);
