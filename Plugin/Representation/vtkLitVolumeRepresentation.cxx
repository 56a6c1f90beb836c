#include "vtkLitVolumeRepresentation.h"

#include "vtkLitVolumeMapper.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODVolume.h"
#include "vtkPVRenderView.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

vtkStandardNewMacro(vtkLitVolumeRepresentation);

namespace
{
/// A shallow copy of an input, which does not change if the upstream filter runs again for another consumer; null if
/// there is no input.
vtkSmartPointer<vtkDataObject> CopyOf(vtkInformationVector* inputs)
{
  vtkSmartPointer<vtkDataObject> copy;
  if (vtkDataObject* const data =
        inputs->GetNumberOfInformationObjects() > 0 ? vtkDataObject::GetData(inputs) : nullptr)
  {
    copy.TakeReference(data->NewInstance());
    copy->ShallowCopy(data);
  }
  return copy;
}
}

vtkLitVolumeRepresentation::vtkLitVolumeRepresentation()
{
  this->SetNumberOfInputPorts(3);
  this->VolumeMapper = vtkSmartPointer<vtkLitVolumeMapper>::New();
}

vtkLitVolumeRepresentation::~vtkLitVolumeRepresentation() = default;

vtkLitVolumeMapper* vtkLitVolumeRepresentation::LitMapper()
{
  return vtkLitVolumeMapper::SafeDownCast(this->VolumeMapper);
}

vtkMediumRayCaster* vtkLitVolumeRepresentation::RayCaster()
{
  return this->LitMapper()->GetRayCaster();
}

vtkParticipatingMedium* vtkLitVolumeRepresentation::Medium()
{
  return this->LitMapper()->GetMedium();
}

int vtkLitVolumeRepresentation::FillInputPortInformation(int port, vtkInformation* information)
{
  information->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == vtkMediumRayCaster::LIGHTS ? "vtkPolyData" : "vtkImageData");
  information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // processes without data have no inputs
  return 1;
}

int vtkLitVolumeRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkMediumRayCaster* const rays = this->RayCaster();
  rays->SetLightsData(CopyOf(inputs[vtkMediumRayCaster::LIGHTS]));
  rays->SetEnvironmentData(CopyOf(inputs[vtkMediumRayCaster::ENVIRONMENT]));
  const int done = this->Superclass::RequestData(request, inputs, outputs);
  this->SharePieces(CopyOf(inputs[vtkMediumRayCaster::MEDIUM]));
  return done;
}

/// Passes this rank's piece with ghost cells, `surrounded`, to the mapper; the superclass has passed the piece without
/// ghost cells. Collective.
void vtkLitVolumeRepresentation::SharePieces(vtkDataObject* surrounded)
{
  vtkMultiProcessController* const ranks = vtkMultiProcessController::GetGlobalController();
  if (ranks && ranks->GetNumberOfProcesses() > 1)
  {
    vtkLitVolumeMapper* const mapper = this->LitMapper();
    mapper->SetPiece(ranks, vtkImageData::SafeDownCast(surrounded));
    mapper->AgreeOnExposure();
  }
}

/// Requests one layer of ghost cells around this rank's piece, because light is interpolated between cells of different
/// pieces.
int vtkLitVolumeRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  for (int i = 0; i < inputs[vtkMediumRayCaster::MEDIUM]->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const information = inputs[vtkMediumRayCaster::MEDIUM]->GetInformationObject(i);
    if (information->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1)
    {
      information->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 1);
    }
  }
  return done;
}

/// Before a frame, lets the mapper exchange the pixels of all ranks' pieces. All ranks have the frame's camera then:
/// vtkSynchronizedRenderers handles the same event first.
void vtkLitVolumeRepresentation::BeforeFrame(vtkObject* renderer, unsigned long, void*)
{
  if (this->GetVisibility())
  {
    this->Actor->ComputeMatrix();
    this->LitMapper()->SeePieces(vtkRenderer::SafeDownCast(renderer), this->Actor);
  }
}

bool vtkLitVolumeRepresentation::AddToView(vtkView* view)
{
  const bool added = this->Superclass::AddToView(view);
  auto* const renderView = vtkPVRenderView::SafeDownCast(view);
  if (added && renderView)
  {
    constexpr float afterOthers = -1.0f;
    this->Observer = renderView->GetRenderer()->AddObserver(
      vtkCommand::StartEvent, this, &vtkLitVolumeRepresentation::BeforeFrame, afterOthers);
  }
  return added;
}

bool vtkLitVolumeRepresentation::RemoveFromView(vtkView* view)
{
  if (auto* const renderView = vtkPVRenderView::SafeDownCast(view))
  {
    renderView->GetRenderer()->RemoveObserver(this->Observer);
  }
  return this->Superclass::RemoveFromView(view);
}

/// Lets the mapper light the array that the image is coloured by, as the superclass lets its mapper show it. A medium
/// with its light is visible even if no array is chosen.
void vtkLitVolumeRepresentation::UpdateMapperParameters()
{
  vtkInformation* const array = this->GetInputArrayInformation(0);
  const char* const name = array ? array->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool isColored = name && name[0] != '\0';
  if (isColored)
  {
    this->Superclass::UpdateMapperParameters();
  }
  this->LitMapper()->SetLightScalars(isColored);
  this->Actor->SetMapper(this->VolumeMapper);
  this->Actor->SetVisibility(this->GetVisibility());
}

// Setters that pass a property to the ray caster, to the mapper, or to the filter that makes a medium of scalars.
#define FORWARD_TO(Filter, Name, Type)                   \
  void vtkLitVolumeRepresentation::Set##Name(Type value) \
  {                                                      \
    this->Filter()->Set##Name(value);                    \
  }
#define FORWARD(Name, Type) FORWARD_TO(RayCaster, Name, Type)
#define FORWARD_TRIPLE(Name)                                                        \
  void vtkLitVolumeRepresentation::Set##Name(double red, double green, double blue) \
  {                                                                                 \
    this->RayCaster()->Set##Name(red, green, blue);                                 \
  }
FORWARD(Quality, int)
FORWARD(SingleScatteringOnly, bool)
FORWARD(ShadowRays, bool)
FORWARD(StepSize, double)
FORWARD(SurfaceReflection, int)
FORWARD(SurfaceIndex, double)
FORWARD(SurfaceReflectance, double)
FORWARD(TableFace, int)
FORWARD(TableReflectance, double)
FORWARD(ShowBackground, bool)
FORWARD(EnvironmentUp, int)
FORWARD(EnvironmentAzimuth, double)
FORWARD(Exposure, double)
FORWARD(ToneCurve, int)
FORWARD(MemoryBudget, int)
FORWARD(Device, const char*)
FORWARD_TRIPLE(TableColor)
FORWARD_TRIPLE(BackgroundColor)
FORWARD_TRIPLE(BackgroundRadiance)
FORWARD_TO(LitMapper, LightsFollowCamera, bool)
FORWARD_TO(LitMapper, FrameTime, double)
FORWARD_TO(Medium, ColorMeans, int)
FORWARD_TO(Medium, MeanCosine, double)
FORWARD_TO(Medium, ExtinctionScale, double)
#undef FORWARD
#undef FORWARD_TO
#undef FORWARD_TRIPLE

double vtkLitVolumeRepresentation::GetUsedExposure()
{
  return this->LitMapper()->GetUsedExposure();
}

void vtkLitVolumeRepresentation::RemoveLights()
{
  this->SetInputConnection(vtkMediumRayCaster::LIGHTS, nullptr);
}

void vtkLitVolumeRepresentation::RemoveEnvironment()
{
  this->SetInputConnection(vtkMediumRayCaster::ENVIRONMENT, nullptr);
}

void vtkLitVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
