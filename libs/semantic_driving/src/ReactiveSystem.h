#pragma once
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/nav/reactive/CAbstractPTGBasedReactive.h>
#include <mrpt_compat/Release.h>
#include <semantic_driving/ReactiveNavigator.h>
#include <semantic_driving/RobotInterface.h>

#include <cstdlib>
#include <stdexcept>

namespace semantic_driving {

/** A folder for the tables that MRPT keeps, gone when it is not needed any more. */
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "reactive-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error(name + ": cannot be created");
    m_path = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

/** How many factors CHolonomicFullEval weighs: it refuses lists that are shorter or longer, so that
 * no file would serve all releases. */
constexpr std::size_t kHolonomicFactors = MSO_MRPT_AT_LEAST(2, 14, 3) ? 8 : 7;

/** Appends zeros, which weigh nothing, to lists of the seven factors that all releases have. */
void completeHolonomicFactors(mrpt::config::CConfigFileBase& file, std::size_t factors);

/** MRPT's navigator, ready to run.
 * \param tables folder of the tables that MRPT makes
 * \throw std::exception the file is missing, or what MRPT does not like about it. */
std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> makeReactiveSystem(
    RobotInterface& robot, const ReactiveNavigator::Options& options, const DriveOptions& limits,
    const std::filesystem::path& tables);

}  // namespace semantic_driving
