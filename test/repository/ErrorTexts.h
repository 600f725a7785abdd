#pragma once
#include <filesystem>
#include <string>
#include <vector>

/** A message that a source says where it throws or refuses something. */
struct ErrorText {
  std::filesystem::path file;
  std::size_t line;  ///< from 1
  std::string text;  ///< its literals, with kGap where something else comes between
};

/** Stands for what a message has of a value, or of one of several texts. */
constexpr char kGap = '\x01';

/** What a source says in `throw`, and in calls of functions named fail..., refuse... or
 * complain..., of ValidationError() and std::cerr. Texts with less than four letters in a row are
 * none: they only put others together. */
std::vector<ErrorText> errorTextsOf(const std::filesystem::path& source);
