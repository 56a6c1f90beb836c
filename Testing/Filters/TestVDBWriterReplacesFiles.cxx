#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtksys/Directory.hxx"
#include "vtkVDBReader.h"
#include "vtkVDBWriter.h"

#include <csignal>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using test::Path;
using test::ReadBytes;

namespace
{
vtkSmartPointer<vtkImageData> SmallImage(int edge = 9)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(edge, edge, edge);
  vtkNew<vtkFloatArray> density;
  density->SetName("density");
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    density->InsertNextValue(float((i * 7919) % 65537));
  }
  image->GetCellData()->AddArray(density);
  return image;
}

struct stat StatusOf(const std::string& path, bool follow = true)
{
  struct stat status = {};
  (follow ? stat : lstat)(path.c_str(), &status);
  return status;
}

unsigned ModeOf(const std::string& path)
{
  return StatusOf(path).st_mode & 07777;
}

/// Files in a folder.
std::size_t CountIn(const std::string& folder)
{
  return vtksys::Directory::GetNumberOfFilesInDirectory(folder) - 2; // . and ..
}

std::string NewFolder(const std::string& name)
{
  vtksys::SystemTools::RemoveADirectory(Path(name));
  vtksys::SystemTools::MakeDirectory(Path(name));
  return Path(name) + "/";
}

struct Writing
{
  vtkNew<vtkVDBWriter> Writer;
  test::Errors Errors{ Writer };

  Writing() { this->Writer->SetInputData(SmallImage()); }

  bool To(const std::string& path)
  {
    this->Writer->SetFileName(path.c_str());
    return this->Writer->Write() == 1;
  }
};

bool IsWhole(const std::string& path)
{
  vtkNew<vtkVDBReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput()->GetNumberOfCells() == 8 * 8 * 8;
}

void LinksAreFollowed(test::Claims& claims)
{
  Writing write;
  const std::string folder = NewFolder("links"), far = NewFolder("links/far");
  test::WriteBytes(far + "real.vdb", "old");
  claims.That(symlink("far/real.vdb", (folder + "one.vdb").c_str()) == 0, "a link");
  claims.That(symlink((folder + "one.vdb").c_str(), (folder + "two.vdb").c_str()) == 0, "a link to a link");
  claims.That(symlink("far/new.vdb", (folder + "dangling.vdb").c_str()) == 0, "a link to what is not there");
  claims.That(symlink("loop.vdb", (folder + "loop.vdb").c_str()) == 0, "a link to itself");
  for (const char* link : { "one.vdb", "two.vdb" })
  {
    test::WriteBytes(far + "real.vdb", "old");
    claims.That(write.To(folder + link) && write.Errors.None(), std::string(link) + " is written");
    claims.That(S_ISLNK(StatusOf(folder + link, false).st_mode), std::string(link) + " stays a link");
    claims.That(
      S_ISREG(StatusOf(far + "real.vdb", false).st_mode) && IsWhole(far + "real.vdb"), "its target is written");
  }
  claims.That(write.To(folder + "dangling.vdb"), "a dangling link is written");
  claims.That(S_ISLNK(StatusOf(folder + "dangling.vdb", false).st_mode) && IsWhole(far + "new.vdb"), "where it leads");
  claims.That(!write.To(folder + "loop.vdb") && write.Errors.WasOneWith("loop.vdb"), "a link to itself is an error");
  claims.That(CountIn(folder) == 5 && CountIn(far) == 2, "and no other file is left");
}

void ModesAndOwnersStay(test::Claims& claims)
{
  Writing write;
  const std::string folder = NewFolder("modes");
  const mode_t before = umask(022);
  for (unsigned mode : { 0600u, 0640u, 0666u, 0755u })
  {
    test::WriteBytes(folder + "old.vdb", "old");
    chmod((folder + "old.vdb").c_str(), mode);
    claims.That(write.To(folder + "old.vdb") && ModeOf(folder + "old.vdb") == mode, "the mode of a file stays");
  }
  for (mode_t mask : { 022u, 027u, 002u, 077u })
  {
    umask(mask);
    unlink((folder + "new.vdb").c_str());
    claims.That(
      write.To(folder + "new.vdb") && ModeOf(folder + "new.vdb") == (0666u & ~mask), "a new file obeys umask");
  }
  umask(before);
  if (geteuid() == 0)
  {
    test::WriteBytes(folder + "theirs.vdb", "old");
    claims.That(chown((folder + "theirs.vdb").c_str(), 12345, 23456) == 0, "another's file");
    chmod((folder + "theirs.vdb").c_str(), 0640);
    claims.That(write.To(folder + "theirs.vdb"), "is written");
    const struct stat status = StatusOf(folder + "theirs.vdb");
    claims.That(
      status.st_uid == 12345 && status.st_gid == 23456 && (status.st_mode & 07777) == 0640, "and stays theirs");
  }
  claims.That(write.Errors.None(), "no errors");
}

void NamesAreAsLongAsTheFileSystemHasThem(test::Claims& claims)
{
  Writing write;
  const std::string folder = NewFolder("names");
  for (std::size_t length : { 240u, 245u, 251u, 255u })
  {
    const std::string name = std::string(length - 4, 'n') + ".vdb";
    claims.That(write.To(folder + name) && IsWhole(folder + name), std::to_string(length) + " characters");
  }
  claims.That(write.Errors.None() && CountIn(folder) == 4, "and nothing else");
  claims.That(!write.To(folder + std::string(252, 'n') + ".vdb") && write.Errors.WasOneWith("cannot be written"),
    "256 are an error");
  claims.That(CountIn(folder) == 4, "that leaves nothing");
}

void WhatMayNotBeWrittenStays(test::Claims& claims)
{
  Writing write;
  const std::string folder = NewFolder("refused");
  test::WriteBytes(folder + "readonly.vdb", "old");
  chmod((folder + "readonly.vdb").c_str(), 0444);
  claims.That(!write.To(folder + "readonly.vdb") && write.Errors.WasOneWith("readonly.vdb"), "a read-only file");
  claims.That(ReadBytes(folder + "readonly.vdb") == "old" && ModeOf(folder + "readonly.vdb") == 0444, "stays");
  vtksys::SystemTools::MakeDirectory(folder + "folder.vdb");
  claims.That(!write.To(folder + "folder.vdb") && write.Errors.WasOneWith("folder.vdb"), "a folder is no file");
  claims.That(mkfifo((folder + "pipe.vdb").c_str(), 0600) == 0, "a pipe");
  claims.That(!write.To(folder + "pipe.vdb") && write.Errors.WasOneWith("pipe.vdb"), "is no place for a file");
  claims.That(S_ISFIFO(StatusOf(folder + "pipe.vdb").st_mode), "and stays one");
  claims.That(
    !write.To(folder + "not/there.vdb") && write.Errors.WasOneWith("not/there.vdb"), "a folder that is not there");
  claims.That(CountIn(folder) == 3, "nothing else is left");

  // A folder that may not be written to, as another user: root may write everywhere.
  char place[] = "/tmp/TestVDBWriterXXXXXX";
  if (mkdtemp(place) == nullptr)
  {
    claims.That(false, "a folder in /tmp");
    return;
  }
  const std::string shut = std::string(place) + "/";
  test::WriteBytes(shut + "there.vdb", "old");
  chmod((shut + "there.vdb").c_str(), 0666);
  chmod(place, 0555);
  const bool root = geteuid() == 0;
  claims.That(!root || seteuid(65534) == 0, "another user");
  claims.That(!write.To(shut + "there.vdb") && write.Errors.WasOneWith("there.vdb"), "a read-only folder is an error");
  claims.That(!write.To(shut + "new.vdb") && write.Errors.WasOneWith("new.vdb"), "for new files too");
  claims.That(!root || seteuid(0) == 0, "root again");
  claims.That(ReadBytes(shut + "there.vdb") == "old" && CountIn(shut) == 1, "and the file stays");

  // The same user where it may write. A process that changed its user does not reach files without a name.
  chmod(place, 0777);
  chmod((shut + "there.vdb").c_str(), 0666);
  const std::string longest = shut + std::string(251, 'n') + ".vdb";
  claims.That(!root || seteuid(65534) == 0, "another user");
  claims.That(write.To(shut + "there.vdb") && write.Errors.None(), "a file that others may write is written");
  claims.That(write.To(longest) && write.Errors.None(), "under a long name too");
  claims.That(!root || seteuid(0) == 0, "root again");
  claims.That(IsWhole(shut + "there.vdb") && IsWhole(longest) && CountIn(shut) == 2, "whole, with nothing else left");
  claims.That(ModeOf(shut + "there.vdb") == 0666, "with its mode");
  vtksys::SystemTools::RemoveADirectory(place);
}

/// A process that is killed while it writes leaves what was there, and nothing beside it.
void AKilledProcessLeavesNothing(test::Claims& claims)
{
  const std::string folder = NewFolder("killed");
  test::WriteBytes(folder + "there.vdb", "old");
  const pid_t child = fork();
  if (child == 0)
  {
    // The disk is full after 1 MB, which kills by SIGXFSZ: in the middle of the file, wherever the machine's speed puts
    // it.
    struct rlimit small = { 1 << 20, 1 << 20 };
    setrlimit(RLIMIT_FSIZE, &small);
    std::signal(SIGXFSZ, SIG_DFL);
    vtkNew<vtkVDBWriter> writer;
    writer->SetInputData(SmallImage(100));
    writer->SetCompression(vtkVDBWriter::NONE);
    writer->SetFileName((folder + "there.vdb").c_str());
    writer->Write();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  claims.That(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ, "the process is killed while it writes");
  claims.That(ReadBytes(folder + "there.vdb") == "old", "what was there stays");
  const int probe = open(folder.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (probe >= 0) // else the file system knows only files with names
  {
    close(probe);
    claims.That(CountIn(folder) == 1, "and nothing half written beside it");
  }
}
}

int TestVDBWriterReplacesFiles(int argc, char* argv[])
{
  test::UseFolder("VDBWriterReplacesFiles", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  AKilledProcessLeavesNothing(claims); // first: OpenVDB's threads would not survive the fork
  LinksAreFollowed(claims);
  ModesAndOwnersStay(claims);
  NamesAreAsLongAsTheFileSystemHasThem(claims);
  WhatMayNotBeWrittenStays(claims);
  return claims.Result();
}
