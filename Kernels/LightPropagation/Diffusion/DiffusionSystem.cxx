#include "LightPropagation/Diffusion/DiffusionSystem.h"

#include "Device/Device.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Floor = 0.05;           ///< minimum optical length between voxel centres in conductances, Eq. (57)
constexpr std::size_t BorderGroup = 256; ///< cells of the box's faces per work-group

bool AreAlike(const std::vector<FlatSourceNode>& a, const std::vector<FlatSourceNode>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FlatSourceNode& one, const FlatSourceNode& other) {
    return one.cosine == other.cosine && one.chord == other.chord && one.weight == other.weight;
  });
}
}

DiffusionSystem::DiffusionSystem(Device& device, MultigridSolver& solver, const Grid& grid,
  const std::array<bool, 3>& periodic, const SweepModel& model, const Arrays& arrays,
  const std::array<double, 6>& incoming, bool linear)
  : TheDevice(device)
  , Inputs(arrays)
  , Count(grid.VoxelCount())
  , BorderCells(BoxFaceCellCount(grid))
  , Solver(solver)
  , Mixing(device, grid.VoxelCount(), this->Values(), "the diffusion system")
{
  this->Layout = LayoutOf(grid, periodic, arrays.stride, arrays.firstT, arrays.first);
  this->Layout.linear = linear;
  std::copy(model.pattern.first.begin(), model.pattern.first.end(), this->Layout.pattern);
  this->Layout.halfRange = static_cast<float>(model.halfRange);
  this->Layout.passing = arrays.passed != nullptr;
  this->Layout.moments = this->HasMoments();
  this->Layout.faces = arrays.faces != nullptr;
  this->Layout.absorbingWeight = this->HasMoments() ? 0.0f : 3.0f;
  this->Layout.floor = static_cast<float>(Floor);
  std::copy(incoming.begin(), incoming.end(), this->Layout.incoming);
  std::copy(arrays.albedo.begin(), arrays.albedo.end(), this->Layout.albedo);

  this->Layout.rows = WithGhostsOwned(this->Solver.Rows());

  const char* what = "the diffusion system";
  std::vector<float> tables = model.pattern.values;
  tables.resize(tables.size() + RowVector);
  this->Pattern = Buffer<float>(device, tables, what);
  this->Model = Buffer<float>(device, this->Count + RowVector, what);
  this->Next = ExactValues(device, this->Values(), what);
  this->Solution = ExactValues(device, this->Values(), what);
  this->Solution.Fill(0.0); // stays 0 for a channel without light, which is not solved
  this->Borders = ExactValues(device, BorderValues * this->BorderCells, what);

  this->FindFlatSource(model);
  cl::Kernel conductance = this->RowsKernel("diffusion_conductance");
  With(conductance, this->Layout, *arrays.sigma_t, *arrays.sigma_a, this->FlatSource, this->Solver.Conductance(),
    this->Solver.Loss());
  this->RunRows(conductance);
  cl::Kernel border = this->Kernel("diffusion_border_loss");
  With(border, this->Layout, *arrays.sigma_t, *arrays.sigma_a, this->Solver.Loss());
  this->RunBorder(border);
  this->FindSkins();
}

cl::Kernel DiffusionSystem::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::DiffusionSystem, ExactOption(this->TheDevice));
}

cl::Kernel DiffusionSystem::RowsKernel(const char* name) const
{
  return this->TheDevice.Kernel(
    name, kernel_source::DiffusionRows, ExactOption(this->TheDevice) + RowOptions(this->TheDevice));
}

void DiffusionSystem::Run(cl::Kernel& kernel)
{
  RunVoxels(this->TheDevice, kernel, this->Layout);
}

void DiffusionSystem::RunBorder(cl::Kernel& kernel)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(RoundUp(this->BorderCells, BorderGroup)), cl::NDRange(BorderGroup));
}

template <class... More>
cl::Kernel DiffusionSystem::OnArrays(const char* name, const More&... more)
{
  const Arrays& inputs = this->Inputs;
  cl::Kernel kernel = this->Kernel(name);
  With(kernel, this->Layout, *inputs.sigma_t, *inputs.sigma_a, *inputs.swept, this->FlatSource,
    this->Solver.Conductance(), *inputs.partialCurrents, this->Passed(), this->Model, this->Pattern, *inputs.source,
    *inputs.path, this->GivenFlux(), this->Faces(), more...);
  return kernel;
}

/// Computes FlatSource and sets Layout.flatStride: one array serves all axes if the sweep is the same along each.
void DiffusionSystem::FindFlatSource(const SweepModel& model)
{
  const auto [x, y, z] = model.flatSource;
  this->Layout.flatStride = AreAlike(x, y) && AreAlike(y, z) ? 0 : this->Layout.stride;
  const std::size_t count = std::max({ x.size(), y.size(), z.size() });
  std::vector<FlatSourceNode> nodes;
  for (std::vector<FlatSourceNode> ofAxis : { x, y, z })
  {
    ofAxis.resize(count, FlatSourceNode{});
    nodes.insert(nodes.end(), ofAxis.begin(), ofAxis.end());
  }
  const Buffer<FlatSourceNode> onDevice(this->TheDevice, nodes, "the directions");
  this->FlatSource = Buffer<float>(
    this->TheDevice, this->Inputs.stride + 2 * this->Layout.flatStride + RowVector, "the diffusion system");
  cl::Kernel kernel = this->RowsKernel("diffusion_flat_source");
  With(kernel, this->Layout, *this->Inputs.sigma_t, *this->Inputs.swept, onDevice, cl_int(count), this->FlatSource);
  this->RunRows(kernel);
  this->TheDevice.Finish(); // the kernel reads `onDevice`, which is destroyed on return
}

/// Finds the rows of voxels that have thick voxels next to thinner ones, and sets Skins, Layout.skin and MostOpaque.
void DiffusionSystem::FindSkins()
{
  this->Skins =
    Buffer<cl_int>(this->TheDevice, tyndall::Count(this->Layout.size[1] * this->Layout.size[2]), "rows of skins");
  this->Skins.Fill(NoSkin);
  const Buffer<float>& extinction = this->ExtinctionInRows();
  cl::Kernel kernel = this->RowsKernel("diffusion_skins");
  With(kernel, this->Layout, extinction, this->Skins);
  this->RunRows(kernel);
  const std::vector<cl_int> rows = this->Skins.Read();
  this->Layout.skin = std::any_of(rows.begin(), rows.end(), [](cl_int any) { return any != NoSkin; });
  this->MostOpaque = *std::max_element(rows.begin(), rows.end());
}

/// Copies sigma_t to rows of the solver's layout, in a scratch array of the solver that the next solve overwrites.
const Buffer<float>& DiffusionSystem::ExtinctionInRows()
{
  const Buffer<float>& extinction = *this->Solver.Scratch().front();
  cl::Kernel rows = this->RowsKernel("diffusion_extinction");
  With(rows, this->Layout, *this->Inputs.sigma_t, extinction);
  this->RunRows(rows);
  return extinction;
}

void DiffusionSystem::ShapeSource()
{
  if (!this->Layout.skin)
  {
    return;
  }
  cl::Kernel kernel = this->Kernel("diffusion_surface_source");
  With(kernel, this->Layout, this->Next.Handle(), *this->Inputs.sigma_t, *this->Inputs.sigma_a, *this->Inputs.swept,
    this->Solver.Conductance(), this->Passed(), this->Skins, *this->Inputs.source);
  this->Run(kernel);
}

void DiffusionSystem::FindModel()
{
  const Arrays& inputs = this->Inputs;
  const Buffer<float>& extinction = this->Layout.skin ? this->ExtinctionInRows() : *inputs.sigma_t;
  cl::Kernel model = this->RowsKernel("diffusion_model");
  With(model, this->Layout, extinction, *inputs.path, this->Next.Handle(), *inputs.source,
    inputs.ofLamps ? *inputs.ofLamps : *inputs.source, *inputs.swept, this->Model);
  this->RunRows(model);
}

void DiffusionSystem::Balance()
{
  const Arrays& inputs = this->Inputs;
  const auto [x, y, z] = this->Solver.Scratch();
  cl::Kernel powers = this->RowsKernel("diffusion_face_powers");
  With(powers, this->Layout, *inputs.sigma_t, *inputs.sigma_a, this->FlatSource, this->Solver.Conductance(),
    *inputs.partialCurrents, this->Passed(), this->Model, this->Pattern, this->GivenFlux(), *x, *y, *z);
  this->RunRows(powers);
  cl::Kernel balance = this->RowsKernel("diffusion_balance");
  With(balance, this->Layout, *inputs.given, *x, *y, *z, this->Solver.Right());
  this->RunRows(balance);
  cl::Kernel border = this->OnArrays("diffusion_border_balance", this->Solver.Right(), this->Borders.Handle());
  this->RunBorder(border);
}

void DiffusionSystem::FindFlux()
{
  if (this->HasMoments())
  {
    const Arrays& inputs = this->Inputs;
    cl::Kernel flux = this->Kernel("diffusion_found_flux");
    With(flux, this->Layout, this->Solver.Conductance(), this->Model, *inputs.path, inputs.moments,
      cl_int(inputs.channel), this->Solution.Handle());
    this->Run(flux);
  }
}

AndersonMixing::Sums DiffusionSystem::SumsOfChange(bool alike) const
{
  const auto& h = this->Layout.spacing;
  // mean edge of a voxel, invariant under permutation of the axes
  const float edge = alike ? 1e20f : std::cbrt(h[0] * h[1] * h[2]);
  return this->Mixing.SumsOf(this->Next, this->Solution, { this->Inputs.sigma_s, this->Inputs.first, edge });
}

double DiffusionSystem::Absorbed() const
{
  cl::Kernel kernel = this->RowsKernel("diffusion_absorbed");
  DiffusionLayout own = this->Layout;
  own.rows = this->Solver.Rows();
  const ExactValues sums(this->TheDevice, RowGroups(this->TheDevice, own.rows), "sums");
  With(kernel, own, *this->Inputs.sigma_a, this->Solution.Handle(), sums.Handle());
  RunRowsOf(this->TheDevice, kernel, own.rows);
  const std::vector<double> parts = sums.Read();
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

DiffusionSystem::BorderSums DiffusionSystem::SumBorders(const std::function<bool(int face, int u, int v)>& counts)
{
  const Arrays& inputs = this->Inputs;
  cl::Kernel kernel = this->Kernel("diffusion_outflow");
  With(kernel, this->Layout, *inputs.sigma_t, *inputs.sigma_a, this->Passed(), this->GivenFlux(), this->Faces(),
    this->Solution.Handle(), this->Borders.Handle());
  this->RunBorder(kernel);
  const std::vector<double> borders = this->Borders.Read();
  BorderSums sums;
  std::size_t at = 0;
  for (int face = 0; face < 6; ++face)
  {
    const PlaneAxes axes = AcrossAxis(face / 2);
    const int width = this->Layout.size[axes.u];
    for (int i = 0; i < width * this->Layout.size[axes.v]; ++i, at += BorderValues)
    {
      if (!counts(face, i % width, i / width))
      {
        continue;
      }
      sums.out[face] += borders[at + BorderNet] + borders[at + BorderShare];
      sums.came[face] += borders[at + BorderCame];
      sums.seeming[face] += borders[at + BorderSeeming];
      const bool several = borders[at + BorderWeight] > 0.0;
      sums.transportWeight += several ? borders[at + BorderWeight] : 0.0;
      sums.shared += several ? 1.0 : 0.0;
    }
  }
  return sums;
}

SurfacePowers DiffusionSystem::PowersAtSurface() const
{
  const std::vector<double> borders = this->Borders.Read();
  SurfacePowers powers;
  powers.halfRange = this->Layout.halfRange;
  const std::size_t cells = borders.size() / BorderValues;
  const std::array<double, 6>& albedo = this->Inputs.albedo;
  const bool reflects = std::any_of(albedo.begin(), albedo.end(), [](double ofFace) { return ofFace > 0.0; });
  const std::vector<float> faces = reflects ? this->Inputs.faces->Read() : std::vector<float>();
  const auto row = [&](std::size_t number) {
    return faces.empty() ? faces
                         : std::vector<float>(faces.begin() + number * cells, faces.begin() + (number + 1) * cells);
  };
  const std::vector<float> back = row(FaceGiven), leaves = row(FaceLeaves);
  std::size_t at = BorderNet;
  for (int face = 0; face < 6; ++face)
  {
    powers.in[face] = this->Layout.incoming[face];
    const PlaneAxes axes = AcrossAxis(face / 2);
    const double area = this->Layout.spacing[axes.u] * this->Layout.spacing[axes.v];
    for (int i = 0; i < this->Layout.size[axes.u] * this->Layout.size[axes.v]; ++i, at += BorderValues)
    {
      powers.net.push_back(borders[at] / area);
      if (!back.empty())
      {
        powers.back.push_back((back[powers.net.size() - 1] + albedo[face] * leaves[powers.net.size() - 1]) / area);
      }
    }
  }
  return powers;
}

void DiffusionSystem::PutNextFlux(const Buffer<float>& path)
{
  cl::Kernel kernel = this->Kernel("diffusion_put_flux");
  With(kernel, this->Layout, this->Next.Handle(), this->Inputs.moments, cl_int(this->Inputs.channel), path);
  this->Run(kernel);
}

void DiffusionSystem::AddFlux(const Buffer<float>& flux)
{
  cl::Kernel kernel = this->OnArrays("diffusion_flux", this->Solution.Handle(), flux);
  this->Run(kernel);
}
}
