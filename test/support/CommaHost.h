#pragma once
#include <clocale>
#include <locale>
#include <string>

/** While this lives, the process writes decimal commas and points between thousands:
 * std::locale::global(), and setlocale() where such a locale is installed. */
class CommaHost {
 public:
  CommaHost()
      : m_global(std::locale::global(std::locale(std::locale::classic(), new Commas))),
        m_before(std::setlocale(LC_NUMERIC, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"})
      std::setlocale(LC_NUMERIC, name);
  }
  ~CommaHost() {
    std::locale::global(m_global);
    std::setlocale(LC_NUMERIC, m_before.c_str());
  }
  CommaHost(const CommaHost&) = delete;
  CommaHost& operator=(const CommaHost&) = delete;

 private:
  struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale m_global;
  std::string m_before;
};
