#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/** Messages of a Markdown file, those in the first column of its tables in `backticks`, that no
 * source below these folders says. What changes in them is written as FILE, NAME, X (a capital
 * alone), a number, or `...`; a part between may be of two texts that a source puts together.
 * \return "file:line: part that is not said" */
std::vector<std::string> messagesNobodySays(const std::filesystem::path& markdownFile,
                                            const std::vector<std::filesystem::path>& sources);

/** The words of a text: what stands between spaces and has a letter or a digit. */
std::size_t countWords(const std::string& text);

/** The sentences of a Markdown text that have four words or more: of paragraphs, list items and
 * cells of tables, without headings and code. A link is its text, and code within a sentence is one
 * word. */
std::vector<std::string> sentencesOf(const std::string& markdown);

/** The smallest of the numbers that a share of them does not exceed. \throw std::invalid_argument
 * no numbers. */
std::size_t quantile(std::vector<std::size_t> numbers, double share);

/** Each returns its findings as "file:line: what is wrong", with paths relative to `root`. */
std::vector<std::string> linesWithTrailingSpace(const std::filesystem::path& root);

/** At the end of a line or, what no editor shows, within it. */
std::vector<std::string> linesWithCarriageReturn(const std::filesystem::path& root);

/** Paths that exist on somebody's machine only, and names of package servers. */
std::vector<std::string> linesTiedToAMachine(const std::filesystem::path& root);

/** Where a program, or a test, reaches into the folder of a program instead of linking a library.
 */
std::vector<std::string> borrowedSources(const std::filesystem::path& root);

/** Names of options and positional arguments with spaces: newer releases of CLI11 abort at them. */
std::vector<std::string> optionNamesWithSpaces(const std::filesystem::path& root);

/** C++ files with more lines than that. */
std::vector<std::string> filesLongerThan(std::size_t maxLines, const std::filesystem::path& root);

/** Links of a Markdown file to files that do not exist. */
std::vector<std::string> brokenLinks(const std::filesystem::path& markdownFile);

/** Blocks of C++ in a Markdown file, below a line that links to a source, which that source does
 * not have: line by line, however they are indented. */
std::vector<std::string> excerptsThatDiffer(const std::filesystem::path& markdownFile);

/** The comment that a CMake file begins with, as one line. */
std::string firstComment(const std::filesystem::path& cmakeFile);
