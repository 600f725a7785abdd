#pragma once
#include <filesystem>
#include <string>

namespace radio {

/** A key that two programs share. Each datagram carries a code behind it that only who has the key
 * can make (HMAC-SHA-256, of which 16 bytes travel). Without a key nothing is added, and everything
 * is taken. */
class Seal {
 public:
  Seal() = default;
  /** \param keyFile All its bytes are the key.
   * \throw std::runtime_error naming it: it cannot be read, or is shorter than 16 bytes. */
  explicit Seal(const std::filesystem::path& keyFile);

  std::string sealed(const std::string& bytes) const;
  /** What was sealed. \throw std::runtime_error with another key, with none, or altered since. */
  std::string opened(const std::string& bytes) const;

 private:
  std::string codeOf(const std::string& bytes) const;

  std::string m_key;  ///< empty: none
};

}  // namespace radio
