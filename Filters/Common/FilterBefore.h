#pragma once

class vtkDataObject;

/// Field data by which the empty outputs of a filter that failed or was aborted inform filters downstream.
namespace tyndall
{
constexpr const char* AbortedFact = "aborted";
constexpr const char* FailedFact = "failed";
/// The output is empty because the file it was read from is, which is no error.
constexpr const char* EmptyFact = "nothing_in_file";
/// Beside FailedFact: a rank did not reach the filter, so that filters downstream do not wait for it again.
constexpr const char* MissingFact = "rank_missing";

/// For an empty input: ends the work of Guarded (Pieces/GuardedWork.h) without an error if the filter upstream failed,
/// was aborted, or read an empty file.
void StopWithFilterBefore(vtkDataObject* input);
}
