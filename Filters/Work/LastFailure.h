#ifndef LastFailure_h
#define LastFailure_h

#include "Common/ArrayTimes.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkTimeStamp.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
/// When a filter's last run failed, and how. VTK runs a filter again with every update while its output does not cover
/// the extent that was asked for, and that is so while the output is empty; ParaView makes several updates. This keeps
/// them from reporting the same error each time.
class LastFailure
{
public:
  enum Kind
  {
    Error,
    Abort,
    Information, ///< an error already of RequestInformation
    Missing,     ///< a rank did not come
  };

  explicit LastFailure(vtkAlgorithm* filter)
    : Filter(filter)
    , Facts(filter->GetInformation())
  {
  }

  bool StillHolds() const
  {
    auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(this->Filter->GetExecutive());
    const vtkMTimeType time = this->Facts->Has(Time()) ? this->Facts->Get(Time()) : 0;
    // The filter's own time, too: ParaView's reader of series calls a reader past its pipeline.
    bool holds = pipeline && std::max(pipeline->GetPipelineMTime(), this->Filter->GetMTime()) < time;
    for (int port = 0; holds && port < this->Filter->GetNumberOfInputPorts(); ++port)
    {
      for (int i = 0; holds && i < this->Filter->GetNumberOfInputConnections(port); ++i)
      {
        holds = TimeOf(this->Filter->GetInputDataObject(port, i)) < time;
      }
    }
    return holds;
  }

  bool Was(Kind kind) const { return this->Facts->Has(Time()) && this->Facts->Get(How()) == kind; }

  void Note(Kind kind)
  {
    vtkTimeStamp now;
    now.Modified();
    this->Facts->Set(Time(), now.GetMTime());
    this->Facts->Set(How(), kind);
  }

  void Forget() { this->Facts->Remove(Time()); }

private:
  /// Not that of the data: ParaView's filters between filters make it anew, with the same arrays, whenever it is looked
  /// at.
  static vtkMTimeType TimeOf(vtkDataObject* data)
  {
    const std::vector<vtkMTimeType> times = TimesOfArrays(data);
    return times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  }

  static vtkInformationUnsignedLongKey* Time()
  {
    static auto* const key = vtkInformationUnsignedLongKey::MakeKey("FAILURE_TIME", "Tyndall");
    return key;
  }

  static vtkInformationIntegerKey* How()
  {
    static auto* const key = vtkInformationIntegerKey::MakeKey("FAILURE_KIND", "Tyndall");
    return key;
  }

  vtkAlgorithm* Filter;
  vtkInformation* Facts;
};
}

#endif
