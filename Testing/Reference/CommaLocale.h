#pragma once

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <string>
#include <unistd.h>

namespace reference
{
/// A locale with a decimal comma and points between thousands, as in Germany, of C and of C++ while it lives. It is
/// compiled here by glibc's localedef, so that no language of the system is needed.
class CommaLocale
{
public:
  CommaLocale()
    : Folder(std::filesystem::temp_directory_path() / ("tyndall_locale_" + std::to_string(getpid())))
  {
    std::filesystem::create_directories(this->Folder);
    const std::string source = (this->Folder / "source").string(), made = (this->Folder / "comma").string();
    std::ofstream(source) << "comment_char %\nescape_char /\nLC_NUMERIC\n"
                             "decimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n";
    // It exits 1 for all that the source leaves out.
    std::system(("localedef -c -f ANSI_X3.4-1968 -i " + source + " " + made + " >/dev/null 2>&1; true").c_str());
    setenv("LOCPATH", this->Folder.c_str(), 1);
    this->Works = std::setlocale(LC_ALL, "comma") != nullptr && std::localeconv()->decimal_point[0] == ',';
    if (this->Works)
    {
      this->Before = std::locale::global(std::locale("comma"));
    }
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale()
  {
    std::locale::global(this->Before);
    std::setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
    std::filesystem::remove_all(this->Folder);
  }

  bool Works = false; ///< a test fails where it does not

private:
  std::filesystem::path Folder;
  std::locale Before;
};
}
