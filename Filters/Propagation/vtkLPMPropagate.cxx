#include "vtkLPMPropagate.h"

#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"

#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
tyndall::PropagationSettings SettingsOf(vtkLPMPropagate* filter)
{
  tyndall::PropagationSettings settings;
  settings.directionsPerFace = filter->GetDirectionsPerFace();
  settings.mapResolution = filter->GetMapResolution();
  settings.storedDirections = filter->GetStoredDirections();
  settings.maximumOrders = 1;
  settings.leaveOut = filter->GetLeaveOut();
  return settings;
}

/// Number of channels of the array `unscattered`: its number of components divided by its number of directions, which
/// is 6 if `storedDirections` is 1, else `storedDirections`.
/// @throws InvalidInput if the number of channels is not 1 or 3
int ChannelsOf(const tyndall::FloatField& unscattered, int storedDirections)
{
  const int sources = storedDirections == 1 ? 6 : storedDirections;
  const int components = unscattered.Components();
  if (components != sources && components != 3 * sources)
  {
    throw tyndall::InvalidInput("Array 'unscattered' has " + std::to_string(components) + " components; with " +
      std::to_string(storedDirections) + " stored direction(s) it must have " + std::to_string(sources) + " or " +
      std::to_string(3 * sources) + ". Give LPMPropagate the same StoredDirections in every order.");
  }
  return components / sources;
}

/// Propagates one scattering order.
/// @return the arrays T (deposits of the rays in the voxels) of the six cube faces, -x to +z: channels vary fastest,
///   then directions of the face, then voxels
std::array<std::vector<float>, 6> PropagateAll(
  tyndall::ParallelPropagation& propagation, std::size_t voxels, const tyndall::Monitor& monitor)
{
  const int perFace = propagation.Model().Directions().PerFace();
  const std::size_t channels = static_cast<std::size_t>(propagation.Model().Channels());
  const std::size_t components = perFace * channels;
  std::array<std::vector<float>, 6> faces;
  for (std::vector<float>& face : faces)
  {
    face.resize(voxels * components);
  }
  for (int batch = 0; batch < propagation.BatchCount(); ++batch)
  {
    propagation.Propagate(batch, monitor);
    int direction = propagation.FirstDirection(batch);
    for (const std::vector<float>& deposits : propagation.Contributions(batch))
    {
      float* target = faces[direction / perFace].data() + direction % perFace * channels;
      for (std::size_t i = 0; i < deposits.size(); ++i)
      {
        target[i / channels * components + i % channels] = deposits[i];
      }
      ++direction;
    }
  }
  return faces;
}

std::vector<std::array<double, 3>> VectorsOf(const tyndall::DirectionSet& set)
{
  std::vector<std::array<double, 3>> vectors;
  for (const tyndall::Direction& direction : set.directions)
  {
    vectors.push_back(direction.omega);
  }
  return vectors;
}
}

vtkStandardNewMacro(vtkLPMPropagate);

vtkLPMPropagate::vtkLPMPropagate()
{
  const tyndall::PropagationSettings defaults;
  this->DirectionsPerFace = defaults.directionsPerFace;
  this->MapResolution = defaults.mapResolution;
  this->StoredDirections = defaults.storedDirections;
  this->LeaveOut = defaults.leaveOut;
}
vtkLPMPropagate::~vtkLPMPropagate() = default;

int vtkLPMPropagate::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Order = 0;
  this->Bytes = 0.0;
  tyndall::WorkOnSubdomains work;
  work.port = MEDIUM;
  work.work = [&](const tyndall::PieceBlocks&, vtkInformationVector** inputs) {
    this->Propagate(inputs, vtkImageData::GetData(outputs, 0));
    return true;
  };
  work.shareResults = [this](
                        tyndall::Communicator& ranks) { tyndall::TakeFromFirstRank(ranks, this->Order, this->Bytes); };
  return tyndall::Guarded(this, request, given, outputs, work);
}

/// Propagates one scattering order through the complete medium, and writes the rays' deposits to the output, arrays
/// `T_xmin` to `T_zmax`.
void vtkLPMPropagate::Propagate(vtkInformationVector** inputs, vtkImageData* output)
{
  vtkImageData* image = vtkImageData::GetData(inputs[MEDIUM]);
  const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
  const tyndall::FloatField unscattered = tyndall::ReadCells(image, "unscattered", tyndall::Need::Optional, {});
  const tyndall::PropagationSettings settings = SettingsOf(this);
  tyndall::Check(settings);
  const bool refracts = tyndall::IsUnusual(this, tyndall::RefractiveIndex, image, "ior", 1.0f);
  const std::vector<std::string> ignored = tyndall::IgnoredIndex(refracts);
  const int channels = unscattered.IsThere() ? ChannelsOf(unscattered, settings.storedDirections) : 1;

  tyndall::Illumination illumination = this->ReadIllumination(inputs);
  tyndall::AddDiffuse(illumination, this->SkyColor, this->FaceRadiance);
  const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(this->Device);
  tyndall::ParallelPropagation propagation(*device, input.medium, illumination, settings, 0, channels);
  if (unscattered.IsThere())
  {
    tyndall::Require(propagation.Model().Channels() == channels,
      "Array 'unscattered' is grey, but the lights are coloured. Give LPMPropagate the same "
      "lights in every order.");
    const std::size_t values = input.medium.grid.VoxelCount() * static_cast<std::size_t>(unscattered.Components());
    propagation.SetSource({ unscattered.Values(), unscattered.Values() + values });
  }
  std::array<std::vector<float>, 6> faces =
    PropagateAll(propagation, input.medium.grid.VoxelCount(), tyndall::MonitorOf(this));

  tyndall::PassOn(image, output);
  for (int face = 0; face < 6; ++face)
  {
    this->Bytes += faces[face].size() * sizeof(float);
    tyndall::AddCells(output, tyndall::NamesOfT[face], std::move(faces[face]),
      settings.directionsPerFace * propagation.Model().Channels());
  }
  this->Order = unscattered.IsThere() ? static_cast<int>(tyndall::ReadFact(image, tyndall::OrderFact, 0.0)) + 1 : 0;
  tyndall::TellLeftOut(this, output, propagation.LeftOut());
  tyndall::AddFact(output, "directions", VectorsOf(propagation.Model().Directions()));
  tyndall::AddFact(output, tyndall::MapResolutionFact, std::vector<double>{ 1.0 * settings.mapResolution });
  tyndall::AddFact(output, tyndall::StoredDirectionsFact, std::vector<double>{ 1.0 * settings.storedDirections });
  tyndall::AddFact(output, tyndall::OrderFact, std::vector<double>{ 1.0 * this->Order });
  tyndall::NoteChoices(this, tyndall::QuantitiesOfMedium(), image, output);
  output->GetFieldData()->RemoveArray(tyndall::IgnoredFact);
  if (refracts)
  {
    tyndall::AddFact(output, tyndall::IgnoredFact, ignored);
    vtkWarningMacro(<< tyndall::WarningOf(ignored));
  }
}

void vtkLPMPropagate::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(
    Device, DirectionsPerFace, MapResolution, StoredDirections, FaceRadiance, SkyColor, LeaveOut, Order, Bytes);
  tyndall::PrintRun(os, indent, this);
}
