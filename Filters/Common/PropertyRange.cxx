#include "PropertyRange.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include "vtkAlgorithm.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringKey.h"
#include "vtkInformationStringVectorKey.h"

#include <vector>

namespace tyndall
{
namespace
{
/// Key in a filter's information: one text for each property whose value is out of range. A text starts with the
/// property's name and a blank.
vtkInformationStringVectorKey* Refused()
{
  static auto* const key = vtkInformationStringVectorKey::MakeKey("REFUSED_PROPERTIES", "Tyndall");
  return key;
}

/// Key in a filter's information: wall-clock time of its last run, s.
vtkInformationDoubleKey* SecondsKey()
{
  static auto* const key = vtkInformationDoubleKey::MakeKey("SECONDS_OF_RUN", "Tyndall");
  return key;
}

/// Key in a filter's information: the computations that its last run skipped, one per line.
vtkInformationStringKey* LeftOutKey()
{
  static auto* const key = vtkInformationStringKey::MakeKey("LEFT_OUT_OF_RUN", "Tyndall");
  return key;
}

vtkInformationIntegerKey* PointDataKey()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("POINT_DATA", "Tyndall");
  return key;
}

std::string Number(double value)
{
  return Text("%.9g", value);
}

std::string Numbers(const double* values, int count)
{
  std::string text;
  for (int i = 0; i < count; ++i)
  {
    text += (i > 0 ? ", " : "") + Number(values[i]);
  }
  return count == 1 ? text : "(" + text + ")";
}

std::string RangeText(double low, double high)
{
  const std::string least = low == AnyLow ? "" : low == AboveZero ? "above 0" : "at least " + Number(low);
  const bool open = high >= AnyHigh || high == VTK_INT_MAX || high == static_cast<double>(VTK_ID_MAX);
  const std::string most = open ? "" : "at most " + Number(high) + (high == LargestFloat ? ", as floats are" : "");
  const std::string both = least + (least.empty() || most.empty() ? "" : " and ") + most;
  return both.empty() ? "finite" : high == AnyHigh ? "finite and " + both : both;
}

std::vector<std::string> TextsOf(vtkAlgorithm* filter)
{
  std::vector<std::string> texts;
  vtkInformation* const information = filter->GetInformation();
  for (int i = 0; i < information->Length(Refused()); ++i)
  {
    texts.emplace_back(information->Get(Refused(), i));
  }
  return texts;
}
}

void NoteProperty(vtkAlgorithm* filter, const char* property, const double* values, int count, double low, double high)
{
  bool refused = false;
  for (int i = 0; i < count; ++i)
  {
    refused = refused || !(values[i] >= low && values[i] <= high);
  }
  const std::vector<std::string> before = TextsOf(filter);
  if (before.empty() && !refused)
  {
    return;
  }
  vtkInformation* const information = filter->GetInformation();
  information->Remove(Refused());
  const std::string name = std::string(property) + " ";
  for (const std::string& text : before)
  {
    if (text.compare(0, name.size(), name) != 0)
    {
      information->Append(Refused(), text.c_str());
    }
  }
  if (refused)
  {
    const std::string text = name + "is " + Numbers(values, count) + "; " + (count == 1 ? "it" : "each number") +
      " must be " + RangeText(low, high) + ".";
    information->Append(Refused(), text.c_str());
  }
}

bool SetPointData(vtkAlgorithm* filter, int& held, int kind)
{
  filter->GetInformation()->Set(PointDataKey(), kind);
  return SetInRange<int>(filter, "PointData", &held, { kind }, VoxelsAroundPoints, AverageToCells);
}

PointDataKind PointDataOf(vtkAlgorithm* filter)
{
  return filter->GetInformation()->Get(PointDataKey()) == AverageToCells ? AverageToCells : VoxelsAroundPoints;
}

double SecondsOfRun(vtkAlgorithm* filter)
{
  return filter->GetInformation()->Get(SecondsKey());
}

const char* LeftOutOfRun(vtkAlgorithm* filter)
{
  const char* const lines = filter->GetInformation()->Get(LeftOutKey());
  return lines ? lines : "";
}

void NoteSeconds(vtkAlgorithm* filter, double seconds)
{
  filter->GetInformation()->Set(SecondsKey(), seconds);
}

void NoteLeftOut(vtkAlgorithm* filter, const std::string& lines)
{
  filter->GetInformation()->Set(LeftOutKey(), lines.c_str());
}

void CheckProperties(vtkAlgorithm* filter)
{
  std::string all;
  for (const std::string& text : TextsOf(filter))
  {
    all += (all.empty() ? "" : " ") + text;
  }
  Require(all.empty(), all);
}
}
