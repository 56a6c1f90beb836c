#pragma once

#include <functional>
#include <string>

class vtkDataObject;

/// Outcomes of work that may fail.
namespace tyndall
{
/// Thrown for an input that is empty because the filter upstream failed, which has reported why.
struct InputFailed
{
};

/// Thrown for an input that is empty on purpose.
struct InputIsEmpty
{
};

struct Ending
{
  enum Kind
  {
    Done,
    Aborted,     ///< no error: nothing is to be shown
    InputFailed, ///< reported by the filter upstream
    Empty,       ///< no error: there is nothing to work on
    Failed,
  };

  Kind kind = Done;
  std::string why; ///< of Failed: a text for users
};

/// Runs `work` and catches whatever it throws.
Ending EndingOf(const std::function<void()>& work);

/// Throws what EndingOf turns into the same outcome; for Failed, InvalidInput.
void Throw(const Ending& ending);

/// Field data by which the empty outputs of a filter that failed or was aborted inform filters downstream.
constexpr const char* AbortedFact = "aborted";
constexpr const char* FailedFact = "failed";
/// The output is empty because the file it was read from is, which is no error.
constexpr const char* EmptyFact = "nothing_in_file";
/// Beside FailedFact: a rank did not reach the filter, so that filters downstream do not wait for it again.
constexpr const char* MissingFact = "rank_missing";

/// For an empty input: ends the work of Guarded (Pieces/GuardedWork.h) without an error if the filter upstream failed,
/// was aborted, or read an empty file.
void StopIfUpstreamFailed(vtkDataObject* input);
}
