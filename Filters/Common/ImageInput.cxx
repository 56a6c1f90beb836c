#include "Common/ImageInput.h"

#include "Device/Errors.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <string>

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
