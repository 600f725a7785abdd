#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

/** What each library may include beside itself and the standard library: the first part of an
 * include's path, such as `mrpt` in <mrpt/poses/CPose3D.h>. */
using IncludeTable = std::map<std::string, std::set<std::string>>;

/** The table in doc/development.md of the boundaries between this project's libraries. */
IncludeTable includeTable(const std::filesystem::path& markdownFile);

/** The includes in the libraries of folder `libs` that the table does not allow, each as
 * "library/src/File.cpp:12: what is wrong". A library without a row in the table is one, too. */
std::vector<std::string> forbiddenIncludes(const std::filesystem::path& libs,
                                           const IncludeTable& table);

/** The first call of what only <algorithm> has in each C++ file that does not include that. Which
 * other headers bring it along changes with the compiler. */
std::vector<std::string> algorithmsWithoutTheirHeader(const std::filesystem::path& root);
