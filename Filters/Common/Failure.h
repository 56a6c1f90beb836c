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
    Aborted,     ///< the work was stopped on request, without an error; the outputs are empty
    InputFailed, ///< the filter upstream failed and has reported the error
    Empty,       ///< the input has no data, without an error
    Failed,
  };

  Kind kind = Done;
  std::string why; ///< message for users if kind is Failed
};

/// Runs `work`, catches any exception and returns it as an outcome.
Ending EndingOf(const std::function<void()>& work);

/// Throws the exception that belongs to an outcome of EndingOf; for Failed this is InvalidInput, whatever the work
/// threw. Does nothing if the work succeeded.
void Throw(const Ending& ending);

/// Names of field data of empty outputs, which inform filters downstream: the filter was aborted, or it failed.
constexpr const char* AbortedFact = "aborted";
constexpr const char* FailedFact = "failed";
/// Name of field data: the output is empty because the file that it was read from contains no data, which is no error.
constexpr const char* EmptyFact = "nothing_in_file";
/// Name of field data, set in addition to FailedFact if a rank did not reach the filter, so that filters downstream do
/// not wait for that rank again.
constexpr const char* MissingFact = "rank_missing";

/// To be called for an empty input. If the input's field data say that the filter upstream failed, was aborted, or read
/// an empty file, ends the filter's work (Guarded) by an exception that is not reported as an error.
void StopIfUpstreamFailed(vtkDataObject* input);
}
