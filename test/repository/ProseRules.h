#pragma once
#include <cstddef>
#include <string>
#include <vector>

/** The words of a text: what stands between spaces and has a letter or a digit. */
std::size_t countWords(const std::string& text);

/** The sentences of a Markdown text that have four words or more: of paragraphs, list items and
 * cells of tables, without headings and code. A link is its text, and code within a sentence is one
 * word. */
std::vector<std::string> sentencesOf(const std::string& markdown);

/** The smallest of the numbers that a share of them does not exceed. \throw std::invalid_argument
 * no numbers. */
std::size_t quantile(std::vector<std::size_t> numbers, double share);
