#include "Common/ImageInput.h"

#include "Device/Errors.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cstring>
#include <string>

namespace tyndall
{
namespace
{
const char* const AnyDataSet = "vtkDataSet"; // no filter has a port for any other reason

bool IsForImages(vtkInformation* port)
{
  const char* const type = port->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
  return type && std::strcmp(type, AnyDataSet) == 0;
}
}

void TakeImages(vtkInformation* port)
{
  port->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), AnyDataSet);
}

void RequireImages(vtkAlgorithm* filter)
{
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    if (!IsForImages(filter->GetInputPortInformation(port)) || filter->GetNumberOfInputConnections(port) == 0)
    {
      continue;
    }
    vtkDataObject* const input = filter->GetInputDataObject(port, 0);
    if (input && !vtkImageData::SafeDownCast(input))
    {
      throw InvalidInput("The input" + (port > 0 ? " " + std::to_string(port) : std::string()) + " is a " +
        input->GetClassName() +
        "; it must be an image, vtkImageData. The filter ResampleToImage (Resample To Image) makes " + "one of it.");
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
