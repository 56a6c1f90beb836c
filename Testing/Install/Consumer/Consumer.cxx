#include <vtkLightRig.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <iostream>

int main()
{
  vtkNew<vtkLightRig> rig;
  rig->AddPointLight(0.0, 0.0, 5.0, 10.0, 10.0, 10.0);
  rig->Update();
  const vtkIdType lights = rig->GetOutput()->GetNumberOfPoints();
  std::cout << lights << " lights\n";
  return lights == 2 ? 0 : 1;
}
