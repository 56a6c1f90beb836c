#include "Common/ImageInput.h"

#include "Device/Errors.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Of a port: that it is for images, whatever it takes.
vtkInformationIntegerKey* ForImages()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("FOR_IMAGES", "Tyndall");
  return key;
}

/// @return which filters of ParaView make an image of such data, as what they do
std::string HowToMakeAnImage(vtkDataObject* data)
{
  const std::string resample = "ResampleToImage (Resample To Image)";
  if (data->IsA("vtkTable"))
  {
    return "The filters TableToStructuredGrid (Table To Structured Grid) and then " + resample + " make one of it.";
  }
  if (data->IsA("vtkHyperTreeGrid"))
  {
    return "The filters HyperTreeGridToUnstructuredGrid (HyperTreeGrid To UnstructuredGrid) and then " + resample +
      " make one of it.";
  }
  if (data->IsA("vtkPolyData"))
  {
    return "The filter MeshVoxelizer (Mesh Voxelizer) makes a medium of a closed mesh, PointVolumeInterpolator (Point "
           "Volume Interpolator) an image of points, and " +
      resample + " one of cells that have a volume.";
  }
  return "The filter " + resample + " makes one of it.";
}
}

void TakeImages(vtkInformation* port)
{
  port->Set(ForImages(), 1);
  port->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : { "vtkDataSet", "vtkUniformGridAMR", "vtkHyperTreeGrid", "vtkTable", "vtkGraph" })
  {
    port->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  }
}

void TakeOneImage(vtkInformation* port)
{
  port->Set(ForImages(), 1);
  port->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
}

void RequireImages(vtkAlgorithm* filter)
{
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    if (!filter->GetInputPortInformation(port)->Has(ForImages()) || filter->GetNumberOfInputConnections(port) == 0)
    {
      continue;
    }
    vtkDataObject* const input = filter->GetInputDataObject(port, 0);
    if (input && !vtkImageData::SafeDownCast(input))
    {
      throw InvalidInput("The input" + (port > 0 ? " " + std::to_string(port) : std::string()) + " is a " +
        input->GetClassName() + "; it must be an image, vtkImageData. " + HowToMakeAnImage(input));
    }
  }
}

namespace
{
/// @throws InvalidInput where an array of these has not a value for each of `count` points, cells or rows
void RequireAsLong(vtkDataSetAttributes* arrays, vtkIdType count, const std::string& elements, const std::string& input)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = arrays->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != count)
    {
      const std::string name = array->GetName() ? array->GetName() : "";
      throw InvalidInput("Array '" + name + "' has " + std::to_string(array->GetNumberOfTuples()) +
        " values where the dataset has " + std::to_string(count) + " " + elements + " (" + input +
        "). Give each of them a value, or leave the array out.");
    }
  }
}
}

void RequireWholeArrays(vtkAlgorithm* filter)
{
  const std::pair<int, const char*> kinds[] = { { vtkDataObject::POINT, "points" }, { vtkDataObject::CELL, "cells" },
    { vtkDataObject::ROW, "rows" } };
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      vtkDataObject* const input = filter->GetInputDataObject(port, i);
      for (const auto& [kind, elements] : kinds)
      {
        if (vtkDataSetAttributes* const arrays = input ? input->GetAttributes(kind) : nullptr)
        {
          RequireAsLong(arrays, input->GetNumberOfElements(kind), elements,
            "input " + std::to_string(port) + ", " + input->GetClassName());
        }
      }
    }
  }
}

void TellSomeExtent(vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const input = inputs->GetInformationObject(0);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* const output = outputs->GetInformationObject(port);
    if (input && !input->Has(Pipeline::WHOLE_EXTENT()) && !output->Has(Pipeline::WHOLE_EXTENT()))
    {
      const int voxel[6] = { 0, 1, 0, 1, 0, 1 };
      output->Set(Pipeline::WHOLE_EXTENT(), voxel, 6);
    }
  }
}
}
