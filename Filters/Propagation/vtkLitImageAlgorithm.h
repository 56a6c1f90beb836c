#ifndef vtkLitImageAlgorithm_h
#define vtkLitImageAlgorithm_h

#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>

class vtkImageData;

/**
 * @class vtkLitImageAlgorithm
 * @brief superclass of the filters that make an image of a medium and what shines on it, on an OpenCL device
 *
 * Output 0 is vtkImageData. Inputs are those of vtkLitMediumAlgorithm; a subclass implements RequestData.
 *
 * @sa vtkLightPropagationMaps vtkLPMPropagate vtkMediumRayCaster
 */
class TYNDALL_EXPORT vtkLitImageAlgorithm : public vtkLitMediumAlgorithm
{
public:
  vtkTypeMacro(vtkLitImageAlgorithm, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkImageData* GetOutput();

  ///@{
  /// Part of the name of the OpenCL device to use, of any case. Default empty: what the variable TYNDALL_DEVICE names,
  /// or else PoCL's CPU device.
  vtkSetStdStringFromCharMacro(Device);
  vtkGetCharFromStdStringMacro(Device);
  ///@}

protected:
  vtkLitImageAlgorithm();
  ~vtkLitImageAlgorithm() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;

  std::string Device;

private:
  vtkLitImageAlgorithm(const vtkLitImageAlgorithm&) = delete;
  void operator=(const vtkLitImageAlgorithm&) = delete;
};

#endif
