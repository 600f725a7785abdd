#pragma once
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <memory>
#include <string>
#include <vector>

#include "CompressedInputStream.h"

namespace labeled_cloud {

/** Reads objects of a rawlog that may be hostile. MRPT reads any class at any place, and follows
 * pointers to what has the wrong one; it makes room for lists before they come. So frames and
 * collections are read here, and each other class is looked at before MRPT makes one. */
class RawlogObjects : public mrpt::serialization::CArchive {
 public:
  explicit RawlogObjects(CompressedInputStream& stream) : m_stream(stream) {}

  /** Null at the end. \throw std::exception as MRPT does: then problem() may know better. */
  mrpt::serialization::CSerializable::Ptr next();
  const std::string& problem() const { return m_problem; }

 private:
  std::size_t read(void* buffer, std::size_t size) override;
  std::size_t write(const void* buffer, std::size_t size) override;

  std::size_t take(char* buffer, std::size_t size);
  mrpt::obs::CSensoryFrame::Ptr frame();
  mrpt::obs::CActionCollection::Ptr actions();
  int versionUpTo(int newest);
  template <class Object>
  std::vector<std::shared_ptr<Object>> objects();
  void expect(bool holds, const std::string& problem);
  bool mayCome(const std::string& className);

  CompressedInputStream& m_stream;
  std::string m_begin;         ///< what was looked at before MRPT reads it
  std::string m_last, m_past;  ///< pieces of few bytes that were read: the last, and the one before
  bool m_isMovement = false;   ///< the last class was a movement in the plane
  bool m_isWhole = false;      ///< an observation or action may come, for it is in no other
  std::string m_problem;
};

}  // namespace labeled_cloud
