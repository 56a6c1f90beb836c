#ifndef vtkLatticeBoltzmannLighting_h
#define vtkLatticeBoltzmannLighting_h

#include "PropertyRange.h"
#include "vtkScatteringSolver.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>
#include <vector>

namespace tyndall
{
struct LatticeSettings;
struct LightField;
struct Photon;
struct SceneBlock;
}

/**
 * @class vtkLatticeBoltzmannLighting
 * @brief diffusion of multiply scattered light, by the lattice Boltzmann method with 18 or 6 directions
 *
 * Every voxel holds a photon density for each link to a neighbouring voxel. Densities collide in the voxel and stream
 * to the neighbours, until they are steady. The limit is a diffusion equation, which is accurate in media in which
 * light is scattered many times; a varying refractive index refracts the diffuse light. By default the scheme conserves
 * power, keeps densities positive for voxels of any optical thickness, and solves for the steady state directly; the
 * published scheme takes explicit steps, and a warning reports where they are too long.
 *
 * Input 0, the medium: vtkImageData of cubic voxels (to 0.1%) with cell arrays (point arrays: see SetPointData)
 *
 * | array      | components | unit             | meaning                                          |
 * |------------|------------|------------------|--------------------------------------------------|
 * | `sigma_a`  | 1 or 3     | 1/length         | absorption coefficient                           |
 * | `sigma_s`  | 1 or 3     | 1/length         | scattering coefficient                           |
 * | `emission` | 1 or 3     | W/(length^3 sr)  | emitted radiance per unit length; optional       |
 * | `ior`      | 1          | 1                | refractive index; optional, default 1            |
 *
 * or the arrays chosen by SetInputArrayToProcess 0, 1, 2 and 3, and field data `g` (default 0), which reduces
 * scattering by the similarity relation, sigma_s (1 - g).
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter; replaces lights and environment (vtkScatteringSolver). Without
 * this input, uncollided light of lights and environment travels in straight lines, even if the index varies. In voxels
 * thicker than a mean free path `mean_direction` of this input determines where within the voxel light is first
 * scattered.
 * Input 4, optional: photons as vtkPhotonEmitter makes them; replace inputs 1 to 3. Photons march along bent rays to
 * their first scattering, either before diffusion starts, or (Interleaved) in alternation with diffusion steps. An
 * error together with input 3 or periodic axes.
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | uncollided part of `fluence`, without light of sky and faces |
 * | `fluence_error` | 1 or 3 | W/length^2 | estimated error of diffusion (if EstimateError or TargetError) |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | 1 or 3 | W/(length^2 sr) | scattered radiance, averaged over directions |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `left_out` (computations that the scene did not need), `device`, `stored_directions`.
 * Output 1: vtkTable, one row per iteration (if the scheme takes steps, per about 16 steps): `iteration`, `seconds`,
 * `residual`, `change`.
 *
 * With Decomposition BLOCKS lines of links continue from rank to rank (numerics.md, section 10 c). BLOCKS supports only
 * the steady-state solve: PUBLISHED, BlockSize, Interleaved and MaximumOrders, which take steps, are errors.
 *
 * EstimateError and TargetError need the conservative scheme. The estimate is the error of the diffusion approximation,
 * from a solve by light propagation maps on a coarse grid (numerics.md, section 10 c), without the noise of photons.
 * With a refractive index it is that of the medium without refraction, and needs even numbers of voxels. No setting
 * reduces this error: if it is above TargetError, a warning names the solvers that can reach the target.
 *
 * @sa vtkLightPropagationMaps vtkDiscreteOrdinates vtkPhotonMarcher vtkParticipatingMedium vtkLightRig
 * @par Thanks
 * R. Geist, K. Rasche, J. Westall, R. Schalkoff: Lattice-Boltzmann Lighting. EGSR 2004.
 * D. Bernabei, A. Hakke Patil, F. Banterle, M. Di Benedetto, F. Ganovelli, S. Pattanaik, R. Scopigno: A Parallel
 * Architecture for Interactive Rendering of Scattering and Refraction Effects.
 */
class TYNDALL_EXPORT vtkLatticeBoltzmannLighting : public vtkScatteringSolver
{
public:
  static vtkLatticeBoltzmannLighting* New();
  vtkTypeMacro(vtkLatticeBoltzmannLighting, vtkScatteringSolver);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Schemes
  {
    PUBLISHED = 0,   ///< explicit collisions, as Bernabei et al. print them, without refraction
    CONSERVATIVE = 1 ///< collisions that conserve power and stay positive for voxels of any optical thickness
  };

  static constexpr int PHOTONS = UNCOLLIDED + 1; ///< input port of the photons

  ///@{
  /// Photons of input 4 (vtkPolyData) by connection or as data; null: none.
  tyndallInputMacro(Photons, PHOTONS);
  ///@}

  ///@{
  /// Number of directions of the lattice: 18 (default), along axes and face diagonals, or 6, along axes only.
  tyndallRangeMacro(Lattice, int, 6, 18);
  ///@}

  ///@{
  /// Collision scheme: PUBLISHED, or CONSERVATIVE (default).
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// Edge, in voxels, of blocks that take StepsPerExchange steps between exchanges with their neighbours. Default 0: no
  /// blocks, all voxels step together; valid 0 and [2, 8]; 4 in the publication.
  tyndallRangeMacro(BlockSize, int, 0, 8);
  ///@}

  ///@{
  /// Whether the march of photons (input 4) alternates with diffusion, as published (Bernabei et al.): VoxelsPerTurn
  /// voxels of each photon's path, then StepsPerExchange diffusion steps, and so on; steps continue until Tolerance is
  /// met. Default off: diffusion starts when the paths of all photons are complete.
  tyndallFlagMacro(Interleaved);
  ///@}

  ///@{
  /// With Interleaved: number of voxels that each photon crosses between diffusion steps. Default 16, valid [0,
  /// 1000000]; 0: all voxels of its path.
  tyndallRangeMacro(VoxelsPerTurn, int, 0, 1000000);
  ///@}

  ///@{
  /// Number of evenly distributed voxels at which the change of fluence between steps is measured. Default 4096, valid
  /// [0, infinity); 0: all voxels.
  tyndallRangeMacro(Probes, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Number of steps of a block (BlockSize) between exchanges with its neighbours; with Interleaved, number of
  /// diffusion steps between marches of the photons. Default 8, valid [1, 1000].
  tyndallRangeMacro(StepsPerExchange, int, 1, 1000);
  ///@}

  ///@{
  /// Number of lattice steps. Default 0: steps until Tolerance is met; the conservative scheme without blocks
  /// (BlockSize 0) then solves for the steady state.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to compute the array `net_flux`. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// Result of the last update: number of steps, or of iterations of the steady-state solve. With this solver the
  /// property BalanceError includes the left-over power.
  vtkGetMacro(Steps, int);
  ///@}

protected:
  vtkLatticeBoltzmannLighting();
  ~vtkLatticeBoltzmannLighting() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  void Note(const tyndall::LightField& light) override;
  void ShareResults(tyndall::Communicator& ranks) override;
  bool KnowsIndex() const override { return this->Scheme == CONSERVATIVE; }
  bool ReadsQuality() const override { return !this->Preview; } // TargetError changes no settings here
  std::string NotByBlocks(vtkInformationVector** inputs) const override;
  tyndall::LightField Solve(const tyndall::SolverScene& scene) override;
  int PortOfShares() const override { return PHOTONS; }
  tyndall::IlluminationInput ReadShining(tyndall::SolverScene& scene, vtkInformationVector** inputs) override;

private:
  vtkLatticeBoltzmannLighting(const vtkLatticeBoltzmannLighting&) = delete;
  void operator=(const vtkLatticeBoltzmannLighting&) = delete;

  tyndall::LatticeSettings Settings() const;
  tyndall::LightField LightOf(const tyndall::SceneBlock& scene, const std::vector<tyndall::Photon>* photons);

  int Lattice;
  int Scheme;
  int BlockSize;
  bool Interleaved;
  int VoxelsPerTurn;
  int Probes;
  int StepsPerExchange;
  int MaximumOrders;
  bool NetFlux;

  int Steps = 0;
};

#endif
