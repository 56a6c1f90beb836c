#pragma once

#include <functional>
#include <string>

class vtkDataObject;

/// Outcomes of work that may fail: success, abort, empty input, error.
namespace tyndall
{
/// Thrown for an input that is empty because the filter upstream failed. That filter has already reported why.
struct InputFailed
{
};

/// Thrown for an input that is empty without an error, such as one read from an empty file.
struct InputIsEmpty
{
};

struct Ending
{
  enum Kind
  {
    Done,
    Aborted,     ///< no error; the outputs are empty
    InputFailed, ///< the filter upstream failed and has reported it
    Empty,       ///< no error; the input has no data
    Failed,
  };

  Kind kind = Done;
  std::string why; ///< for Failed: message for users
};

/// Runs `work`, catches any exception and returns it as an outcome.
Ending EndingOf(const std::function<void()>& work);

/// Throws the exception that EndingOf turns into this outcome; for Failed, InvalidInput.
void Throw(const Ending& ending);

/// Names of field data. The empty outputs of a filter that failed or was aborted carry them to inform filters
/// downstream.
constexpr const char* AbortedFact = "aborted";
constexpr const char* FailedFact = "failed";
/// The output is empty because the file that it was read from contains no data, which is no error.
constexpr const char* EmptyFact = "nothing_in_file";
/// Set in addition to FailedFact if a rank did not reach the filter, so that filters downstream do not wait for it
/// again.
constexpr const char* MissingFact = "rank_missing";

/// For an empty input: ends the work of Guarded (Pieces/GuardedWork.h) without an error if the filter upstream failed,
/// was aborted, or read an empty file.
void StopIfUpstreamFailed(vtkDataObject* input);
}
