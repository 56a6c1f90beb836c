#include "Device/PoclCache.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <elf.h>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <locale>
#include <map>
#include <optional>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace fs = std::filesystem;

namespace tyndall
{
namespace
{
constexpr const char* Aside = PoclCache::Damaged;

/// Whether the bytes are complete LLVM bitcode: a signature, then blocks that each state their number of words.
bool IsWholeBitcode(const std::string& bytes)
{
  const auto word = [&bytes](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
  };
  constexpr std::uint32_t signature = 0xdec04342, isBlock = 1;
  if (bytes.size() < 8 || word(0) != signature)
  {
    return false;
  }
  std::size_t at = 4;
  while (at + 8 <= bytes.size() && (word(at) & 3) == isBlock)
  {
    at += 8 + 4 * static_cast<std::size_t>(word(at + 4));
  }
  return at == bytes.size();
}

/// Whether the bytes are a complete library: all of its sections must lie within the file.
bool IsWholeLibrary(const std::string& bytes)
{
  Elf64_Ehdr header = {};
  std::memcpy(&header, bytes.data(), std::min(sizeof(header), bytes.size()));
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64)
  {
    return header.e_ident[EI_CLASS] == ELFCLASS32; // 32-bit libraries have other headers, which are not checked
  }
  const auto lies = [&bytes](std::uint64_t from, std::uint64_t size) {
    return from <= bytes.size() && size <= bytes.size() - from;
  };
  bool whole = header.e_shnum > 0 && lies(header.e_shoff, header.e_shnum * sizeof(Elf64_Shdr));
  for (std::size_t i = 0; whole && i < header.e_shnum; ++i)
  {
    Elf64_Shdr section = {};
    std::memcpy(&section, bytes.data() + header.e_shoff + i * sizeof(section), sizeof(section));
    whole = section.sh_type == SHT_NOBITS || lies(section.sh_offset, section.sh_size);
  }
  return whole;
}

std::optional<std::string> BytesOf(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::string bytes;
  std::vector<char> block(1 << 16);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0)
  {
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return stream.eof() && !stream.bad() ? std::optional<std::string>(std::move(bytes)) : std::nullopt;
}

/// Recorded state of a file or folder of PoCL's cache, by which later changes are detected.
struct Note
{
  std::uint64_t number = 0; ///< inode number
  std::uint64_t size = 0;   ///< size, bytes
  std::int64_t written = 0; ///< time of the last change of contents, ns
  std::int64_t changed = 0; ///< time of the last change of contents, name or permissions, ns
  std::uint64_t sum = 0;    ///< checksum of a file's bytes

  bool LooksLike(const Note& other) const
  {
    return this->number == other.number && this->size == other.size && this->written == other.written &&
      this->changed == other.changed;
  }
};

/// Current state of a file or folder, without its checksum; no value if it does not exist.
std::optional<Note> NoteOf(const std::string& path)
{
  struct stat found = {};
  if (stat(path.c_str(), &found) != 0)
  {
    return std::nullopt;
  }
  const auto nanoseconds = [](const timespec& time) { return time.tv_sec * std::int64_t(1000000000) + time.tv_nsec; };
  return Note{ found.st_ino, static_cast<std::uint64_t>(found.st_size), nanoseconds(found.st_mtim),
    nanoseconds(found.st_ctim), 0 };
}

// Checksum of the bytes by the hash function FNV-1a.
std::uint64_t SumOf(const std::string& bytes)
{
  std::uint64_t sum = 14695981039346656037u;
  for (const char byte : bytes)
  {
    sum = (sum ^ static_cast<unsigned char>(byte)) * 1099511628211u;
  }
  return sum;
}

/// Recorded states and checksums of the files in a folder, by relative path, stored in a file of that folder.
class Notes
{
public:
  explicit Notes(const std::string& folder)
    : File(folder + "/tyndall-checksums")
  {
    std::ifstream stream(this->File);
    stream.imbue(std::locale::classic());
    Note note;
    std::string path;
    while (stream >> note.number >> note.size >> note.written >> note.changed >> note.sum &&
      std::getline(stream >> std::ws, path))
    {
      this->Known.emplace_hint(this->Known.end(), path, note);
    }
  }

  const std::map<std::string, Note>& All() const { return this->Known; }
  const Note* Find(const std::string& path) const
  {
    const auto found = this->Known.find(path);
    return found == this->Known.end() ? nullptr : &found->second;
  }
  void Set(const std::string& path, const Note& note)
  {
    this->Known[path] = note;
    this->IsNew = true;
  }
  void Forget(const std::string& path) { this->IsNew = this->Known.erase(path) > 0 || this->IsNew; }

  /// Writes the recorded states to a new file, then renames it, because other processes may write at the same time.
  void Write() const
  {
    if (!this->IsNew)
    {
      return;
    }
    const std::string written = this->File + "-" + std::to_string(getpid());
    std::ofstream stream(written);
    for (const auto& [path, note] : this->Known)
    {
      stream << std::to_string(note.number) + " " + std::to_string(note.size) + " " + std::to_string(note.written) +
          " " + std::to_string(note.changed) + " " + std::to_string(note.sum) + " " + path + "\n";
    }
    stream.close();
    if (!stream || std::rename(written.c_str(), this->File.c_str()) != 0)
    {
      unlink(written.c_str());
    }
  }

private:
  std::string File;
  std::map<std::string, Note> Known;
  bool IsNew = false;
};

/// Inspection of PoCL's cache folder with as few system calls as possible. It checks the files whose state an earlier
/// inspection recorded, and the program folders that have changed since then.
class CacheInspection
{
public:
  /// Function that is called for each damaged file, with its path in the folder and how it is damaged. It returns
  /// whether the file was removed.
  using Report = std::function<bool(const std::string& path, const std::string& how)>;

  /// Reads the states of files that earlier inspections recorded in the folder.
  /// @param folder  name of PoCL's cache folder without a trailing slash
  explicit CacheInspection(const std::string& folder)
    : Folder(folder)
    , Known(folder)
  {
  }

  void Run(const Report& report)
  {
    std::vector<std::string> noted;
    for (const auto& [path, note] : this->Known.All())
    {
      const std::optional<Note> found = NoteOf(this->Folder + path);
      if (!found || (IsOfKernels(path) && !found->LooksLike(note)))
      {
        noted.push_back(path);
      }
    }
    for (const std::string& path : noted)
    {
      this->LookAtFile(path, report);
    }
    for (const std::string& program : this->ChangedPrograms())
    {
      this->LookInto(program, report);
    }
    this->Known.Write();
  }

  void ReportAllPrograms(const Report& report)
  {
    for (const std::string& program : this->Programs())
    {
      report(program, "was set aside, for two runs ended while they built kernels");
      const std::map<std::string, Note> known = this->Known.All();
      for (auto note = known.lower_bound(program); note != known.end() && note->first.rfind(program, 0) == 0; ++note)
      {
        this->Known.Forget(note->first);
      }
    }
    this->Known.Write();
  }

private:
  static bool IsOfKernels(const fs::path& path) { return path.extension() == ".bc" || path.extension() == ".so"; }
  static bool CanBeUsed(const fs::path& folder) { return access(folder.c_str(), R_OK | W_OK | X_OK) == 0; }
  /// Whether a file name consists of `least` to `most` capital letters. The names of PoCL's program folders do, since
  /// they are hashes. Other files in the cache folder are ignored.
  static bool IsOfHash(const fs::path& path, std::size_t least, std::size_t most)
  {
    const std::string name = path.filename().string();
    return name.size() >= least && name.size() <= most &&
      std::all_of(name.begin(), name.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  }
  std::string Within(const fs::path& path) const { return path.string().substr(this->Folder.size()); }

  std::vector<std::string> ChangedPrograms() const
  {
    std::vector<std::string> programs = this->Programs();
    const auto isKnown = [this](const std::string& path) {
      const Note* const before = this->Known.Find(path);
      const std::optional<Note> found = NoteOf(this->Folder + path);
      return before && found && found->LooksLike(*before);
    };
    programs.erase(std::remove_if(programs.begin(), programs.end(), isKnown), programs.end());
    return programs;
  }

  std::vector<std::string> Programs() const
  {
    std::vector<std::string> programs;
    std::error_code none;
    for (const auto& above : fs::directory_iterator(this->Folder, none))
    {
      if (!IsOfHash(above.path(), 2, 2) || !above.is_directory(none))
      {
        continue;
      }
      for (const auto& program : fs::directory_iterator(above.path(), none))
      {
        if (IsOfHash(program.path(), 20, 64) && program.is_directory(none))
        {
          programs.push_back(this->Within(program.path()));
        }
      }
    }
    return programs;
  }

  void LookInto(const std::string& program, const Report& report)
  {
    const fs::path folder = this->Folder + program;
    if (!CanBeUsed(folder))
    {
      report(program, "cannot be used");
      return;
    }
    const std::optional<Note> found =
      // state of the folder before its inspection, so that the next inspection detects changes made in the meantime
      NoteOf(folder.string());
    std::vector<std::string> files, unusable;
    std::error_code none;
    for (fs::recursive_directory_iterator entry(folder, none), end; entry != end; entry.increment(none))
    {
      const fs::path& path = entry->path();
      if (!entry->is_directory(none))
      {
        files.insert(files.end(), IsOfKernels(path) ? 1 : 0, this->Within(path));
        continue;
      }
      const bool unfit = path.extension() != Aside && (IsOfKernels(path) || !CanBeUsed(path));
      unusable.insert(unusable.end(), unfit ? 1 : 0, this->Within(path));
      if (unfit || path.extension() == Aside)
      {
        entry.disable_recursion_pending();
      }
    }
    bool sound = unusable.empty();
    for (const std::string& path : files)
    {
      sound = this->LookAtFile(path, report) && sound;
    }
    for (const std::string& path : unusable)
    {
      report(path, "cannot be used");
    }
    // Time stamps of file systems are coarse: the state of a folder is recorded only if its last change was more than a
    // second ago.
    const bool rests = found && std::time(nullptr) - found->changed / 1000000000 > 1;
    if (sound && rests) // a folder that is not recorded as known is inspected again by the next process
    {
      this->Known.Set(program, *found);
    }
  }

  /// Inspects a file of a compiled program, and reports it if it is damaged.
  /// @return whether the file is intact
  bool LookAtFile(const std::string& path, const Report& report)
  {
    const std::string file = this->Folder + path;
    const Note* const before = this->Known.Find(path);
    std::optional<Note> found = NoteOf(file);
    if (!found) // the file was renamed, perhaps by another process
    {
      this->Known.Forget(path);
      return true;
    }
    if (before && found->LooksLike(*before))
    {
      return true;
    }
    const std::string how = this->HowDamaged(file, before, *found);
    if (!how.empty())
    {
      if (report(path, how))
      {
        this->Known.Forget(path);
      }
      return false;
    }
    this->Known.Set(path, *found);
    return true;
  }

  /// Compares a file with its recorded state and checks its contents.
  /// @param before  recorded state of the file; null: it is new
  /// @param found  current state of the file; receives its checksum
  /// @return how the file is damaged; empty if no damage was found
  static std::string HowDamaged(const fs::path& file, const Note* before, Note& found)
  {
    const std::optional<std::string> bytes = BytesOf(file);
    if (!bytes)
    {
      return "cannot be read";
    }
    if (!(file.extension() == ".so" ? IsWholeLibrary(*bytes) : IsWholeBitcode(*bytes)))
    {
      return "is cut off or overwritten";
    }
    found.sum = SumOf(*bytes);
    // Bitcode that was replaced is not damaged. Ranks that compile the same program at once replace each other's file,
    // and the new file may differ in some bytes.
    const bool replaced = before && before->number != found.number && file.extension() == ".bc";
    return before && before->sum != found.sum && !replaced ? "was changed" : "";
  }

  std::string Folder;
  Notes Known;
};

constexpr const char* PrefixOfMarks = "tyndall-building-";

/// Approximate start time of this process. Ranks of one job start together, so that their start times are nearly equal.
const std::time_t Begun = std::time(nullptr);

/// Whether two or more processes that started at least ten seconds apart ended while they were building programs. PoCL
/// may have ended them by loading damaged bitcode. If so, deletes the marks (files of BuildMark) of these processes;
/// always deletes marks older than an hour. A mark whose lock is free belongs to a process that has ended.
bool EndedWhileBuilding(const std::string& folder)
{
  constexpr std::int64_t second = 1000000000, apart = 10 * second, old = 3600 * second;
  // Names and descriptors of the files that mark unfinished builds of ended processes.
  std::vector<std::pair<std::string, int>> ended;
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
  {
    const std::string mark = entry.path().string();
    const std::optional<Note> found = NoteOf(mark);
    if (entry.path().filename().string().rfind(PrefixOfMarks, 0) != 0 || !found)
    {
      continue;
    }
    const int file = open(mark.c_str(), O_RDONLY | O_CLOEXEC);
    const bool hasEnded = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
    if (hasEnded && std::time(nullptr) * second - found->written > old)
    {
      unlink(mark.c_str());
    }
    else if (hasEnded)
    {
      ended.emplace_back(mark, file);
      first = std::min(first, found->written);
      last = std::max(last, found->written);
      continue;
    }
    if (file >= 0)
    {
      close(file);
    }
  }
  const bool twice = !ended.empty() && last - first >= apart;
  for (const auto& [mark, file] : ended)
  {
    if (twice)
    {
      unlink(mark.c_str());
    }
    close(file);
  }
  return twice;
}

std::string WithoutSlash(std::string folder)
{
  while (folder.size() > 1 && folder.back() == '/')
  {
    folder.pop_back();
  }
  return folder;
}

}

BuildMark::BuildMark(const std::string& folder)
{
  if (folder.empty())
  {
    return;
  }
  std::string name = WithoutSlash(folder) + "/" + PrefixOfMarks + "XXXXXX";
  this->Descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (this->Descriptor < 0)
  {
    return;
  }
  this->File = name;
  flock(this->Descriptor, LOCK_EX);
  const timespec times[] = { { Begun, 0 }, { Begun, 0 } };
  futimens(this->Descriptor, times);
}

BuildMark::~BuildMark()
{
  if (!this->File.empty())
  {
    unlink(this->File.c_str());
    close(this->Descriptor);
  }
}

DamagedFiles SetDamagedAside(const std::string& said)
{
  const std::string folder = WithoutSlash(said);
  DamagedFiles all;
  CacheInspection inspection(folder);
  const CacheInspection::Report setAside = [&](const std::string& path, const std::string& how) {
    const std::string place = folder + path;
    std::error_code error;
    fs::remove_all(place + Aside, error);
    fs::rename(place, place + Aside, error);
    if (error && fs::exists(place)) // if it does not exist, another process has renamed it
    {
      all.trouble = "\"" + place + "\" " + how + ", and cannot be renamed";
    }
    all.first = all.count == 0 ? "\"" + path.substr(1) + "\" " + how : all.first;
    ++all.count;
    return !fs::exists(place);
  };
  inspection.Run(setAside);
  if (EndedWhileBuilding(folder))
  {
    inspection.ReportAllPrograms(setAside);
  }
  return all;
}

void NoteChecksums(const std::string& folder)
{
  CacheInspection(WithoutSlash(folder)).Run([](const std::string&, const std::string&) {
    return false;
  }); // damaged files are not removed here, but by the next process
}
}
