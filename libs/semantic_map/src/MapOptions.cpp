#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/MapOptions.h>
#include <strict_files/IniSection.h>

#include <ostream>
#include <stdexcept>

#include "ArchiveStream.h"

namespace semantic_map {

using mrpt::config::CConfigFileBase;
using mrpt::serialization::CArchive;
using strict_files::above;
using strict_files::atLeast;
using strict_files::checkOptions;
using strict_files::IniSection;
using strict_files::Option;
using strict_files::OptionList;

namespace {

/** Options that MRPT itself reads from a section of the map. */
std::vector<std::string> foreignKeys(const TCreationOptions&) {
  return {"enableSaveAs3DObject", "enableObservationLikelihood", "enableObservationInsertion"};
}
template <class Other>
std::vector<std::string> foreignKeys(const Other&) {
  return {};
}

}  // namespace

template <class Derived>
void TNamedOptions<Derived>::loadFromConfigFile(const CConfigFileBase& source,
                                                const std::string& section) {
  Derived loaded = static_cast<Derived&>(*this);
  IniSection ini(source, section);
  ini.read(OptionList::of(loaded));
  for (const std::string& key : foreignKeys(loaded)) ini.text(key);
  ini.finish();
  try {
    loaded.validate();
  } catch (const std::invalid_argument& e) {
    ini.fail(e.what());
  }
  static_cast<Derived&>(*this) = loaded;
}

template <class Derived>
void TNamedOptions<Derived>::saveToConfigFile(CConfigFileBase& target,
                                              const std::string& section) const {
  Derived copy = static_cast<const Derived&>(*this);
  for (const Option& option : OptionList::of(copy).options())
    // No padding, which MRPT would take for a part of the key.
    target.write(section, option.name, option.text(), -1, -1, option.help);
}

template <class Derived>
void TNamedOptions<Derived>::dumpToTextStream(std::ostream& out) const {
  Derived copy = static_cast<const Derived&>(*this);
  for (const Option& option : OptionList::of(copy).options())
    out << "  " << option.name << " = " << option.text() << "  // " << option.help << "\n";
}

template <class Derived>
void TNamedOptions<Derived>::writeTo(CArchive& out) const {
  Derived copy = static_cast<const Derived&>(*this);
  const OptionList list = OptionList::of(copy);
  out.WriteAs<std::uint32_t>(list.options().size());
  for (const Option& option : list.options()) out << option.name << option.text();
}

template <class Derived>
void TNamedOptions<Derived>::readFrom(CArchive& in) {
  Derived read;
  const OptionList list = OptionList::of(read);
  for (auto left = in.ReadAs<std::uint32_t>(); left > 0; --left) {
    const std::string name = readText(in), text = readText(in);
    const Option* option = list.find(name);
    if (!option) continue;  // one that programs had before: the map is worth more
    try {
      option->set(text);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(name + " " + e.what());
    }
  }
  read.validate();
  static_cast<Derived&>(*this) = read;
}

void TCreationOptions::describe(OptionList& list) {
  list.add(
      "resolution", resolution, "m", above(0),
      "edge of a voxel; half of it is eight times the memory. 0.2 for streets and LiDARs, 0.05 "
      "for rooms");
  list.add(
      "classes", classes, "",
      "class table (YAML), relative to the .ini file for our programs, to the working directory "
      "for MRPT's. Without: a single class, \"occupied\", or for rawlog2semantic-map those that "
      "the rawlog's labels name");
}

void TCreationOptions::validate() const { checkOptions(*this, "TCreationOptions"); }

void TFolderOptions::describe(OptionList& list) {
  list.add("folder", folder, "",
           "folder of tiles that the map is in, relative to the working directory. Without: the "
           "map is in memory");
  list.add("read_only", readOnly, "", "its map is read, by as many as like, and stays as it is");
  tiles.describe(list);
}

void TFolderOptions::validate() const { checkOptions(*this, "TFolderOptions"); }

void TInsertionOptions::describe(OptionList& list) {
  scan.describe(list);
  list.add("max_gap", maxGap, "s", atLeast(0),
           "time between observations by which classes with a half-life are forgotten; a longer "
           "silence is another recording and not counted; 0: all of it is");
  conversion.describe(list);
  filter.describe(list);
}

void TInsertionOptions::validate() const { checkOptions(*this, "TInsertionOptions"); }

void TLikelihoodOptions::describe(OptionList& list) {
  list.add("decimation", decimation, "", atLeast(1), "one of that many points counts");
  list.add("use_labels", useLabels, "", "compare classes too, not only occupancy");
  list.add("beam_step", beamStep, "m", atLeast(0),
           "between the places where a beam is seen to pass; 0: only its end counts");
  list.add("point_weight", pointWeight, "", above(0).upTo(1),
           "factor on each point's log-likelihood, for neighbors are not independent");
}

void TLikelihoodOptions::validate() const { checkOptions(*this, "TLikelihoodOptions"); }

const strict_files::Choices<TRenderingOptions::Coloring>& choicesOf(TRenderingOptions::Coloring) {
  using Coloring = TRenderingOptions::Coloring;
  static const strict_files::Choices<Coloring> choices = {{"class", Coloring::Class},
                                                          {"probability", Coloring::Probability},
                                                          {"entropy", Coloring::Entropy}};
  return choices;
}

void TRenderingOptions::describe(OptionList& list) {
  const auto anything = strict_files::Range().orInfinite();
  list.add("coloring", coloring, "", "what the colors of cells show");
  list.add("free", free, "", "show free cells");
  list.add("compressed", compressed, "", "show the optimal abstraction, where one is kept");
  list.add("min_height", minHeight, "m", anything, "lower cells are left out");
  list.add("max_height", maxHeight, "m", anything, "higher cells are left out");
}

void TRenderingOptions::validate() const {
  checkOptions(*this, "TRenderingOptions");
  strict_files::require(minHeight <= maxHeight, "TRenderingOptions::min_height", minHeight,
                        "at most max_height");
}

template class TNamedOptions<TCreationOptions>;
template class TNamedOptions<TFolderOptions>;
template class TNamedOptions<TInsertionOptions>;
template class TNamedOptions<TLikelihoodOptions>;
template class TNamedOptions<TAbstractionOptions>;
template class TNamedOptions<TRenderingOptions>;

}  // namespace semantic_map
