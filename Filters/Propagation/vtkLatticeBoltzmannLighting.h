#ifndef vtkLatticeBoltzmannLighting_h
#define vtkLatticeBoltzmannLighting_h

#include "PropertyRange.h"
#include "vtkScatteringSolver.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>
#include <vector>

namespace tyndall
{
class Domain;
class FloatField;
struct LatticeSettings;
struct LightField;
struct MediumInput;
struct Photon;
struct PreviewScene;
}

/**
 * @class vtkLatticeBoltzmannLighting
 * @brief light that is scattered very often, as it diffuses on a lattice of 18 or 6 directions
 *
 * Every voxel holds photon density along its links to neighbours, which collides there and moves on, until it is
 * steady. It is diffusion: for media in which light is scattered many times, also where the refractive index varies,
 * which bends what diffuses, too. By default power is kept and light positive whatever voxels are, and the steady state
 * is solved for; as published light goes in explicit steps, and a warning says where they are too long.
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
 * or those chosen by SetInputArrayToProcess 0, 1, 2 and 3, and field data `g` (default 0): diffusion takes it by the
 * similarity relation.
 * Input 1, optional: lights as vtkLightRig makes them.
 * Input 2, optional: the environment, as vtkEnvironmentReader makes it.
 * Input 3, optional: uncollided light of another filter instead of all these (vtkScatteringSolver); that of lights and
 * environment goes straight, whatever the index. In voxels thicker than a mean free path its `mean_direction` tells
 * where it is first scattered.
 * Input 4, optional: photons as vtkPhotonEmitter makes them, instead of all these: they march along bent rays to where
 * they are first scattered, to their ends first, or (Interleaved) while their light diffuses. Not together with 3, nor
 * with periodic axes.
 *
 * Output 0: the medium's image with cell arrays of 1 component, or 3 where medium or light has colour
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `fluence` | 1 or 3 | W/length^2 | radiance integrated over all directions |
 * | `fluence_direct` | 1 or 3 | W/length^2 | its unscattered part, without that of sky and faces |
 * | `net_flux` | 3 or 9 | W/length^2 | radiance times direction, integrated (if NetFlux) |
 * | `scattered_radiance` | 1 or 3 | W/(length^2 sr) | radiance scattered, in the mean over directions |
 *
 * and field data `energy_balance` (W: entered, emitted, absorbed, escaped, left over), `face_power_out` (W through -x,
 * +x, -y, +y, -z, +z), `left_out` (what the scene did not need), `device`, `stored_directions`.
 * Output 1: vtkTable, one row an iteration (of steps: every 16 or so): `iteration`, `seconds`, `residual`, `change`.
 *
 * With Decomposition BLOCKS lines of links continue from rank to rank (numerics.md, section 10 c). Only the steady
 * state is solved so: PUBLISHED, BlockSize, Interleaved and MaximumOrders, which take steps, are an error then.
 *
 * EstimateError is not used.
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
    CONSERVATIVE = 1 ///< collisions that keep power and are positive for voxels of any thickness
  };

  static constexpr int PHOTONS = UNCOLLIDED + 1; ///< number of the input port

  ///@{
  /// Photons (vtkPolyData) by connection or as data; null: none.
  tyndallInputMacro(Photons, PHOTONS);
  ///@}

  ///@{
  /// Directions of the lattice: 18 (default), along axes and diagonals, or 6 along axes alone.
  tyndallRangeMacro(Lattice, int, 6, 18);
  ///@}

  ///@{
  /// How light collides: PUBLISHED, or CONSERVATIVE (default).
  tyndallRangeMacro(Scheme, int, PUBLISHED, CONSERVATIVE);
  ///@}

  ///@{
  /// Edge of blocks, voxels, 2 to 8, that step by themselves, as published with 4. Default 0: all voxels together.
  tyndallRangeMacro(BlockSize, int, 0, 8);
  ///@}

  ///@{
  /// Whether photons, where there are any, march while what they have left so far diffuses, by StepsPerExchange steps
  /// to VoxelsPerTurn voxels of their ways, as published (Bernabei et al.); steps go on until Tolerance is met.
  /// Default off: they march to their ends first.
  tyndallFlagMacro(Interleaved);
  ///@}

  ///@{
  /// Voxels that photons cross in a turn, where Interleaved. Default 16, valid [0, 1000000]; 0: to the end of their
  /// ways.
  tyndallRangeMacro(VoxelsPerTurn, int, 0, 1000000);
  ///@}

  ///@{
  /// Voxels, spread evenly, at which it is looked how much light changes by steps. Default 4096, valid [0, infinity);
  /// 0: all.
  tyndallRangeMacro(Probes, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Steps of a block before it exchanges light with its neighbours, and steps of the lattice to a turn of photons.
  /// Default 8, valid [1, 1000].
  tyndallRangeMacro(StepsPerExchange, int, 1, 1000);
  ///@}

  ///@{
  /// Steps to do. Default 0: until Tolerance is met; of the conservative scheme without blocks the steady state is then
  /// solved for.
  tyndallRangeMacro(MaximumOrders, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to compute `net_flux` too. Default off.
  tyndallFlagMacro(NetFlux);
  ///@}

  ///@{
  /// What came of the last update: steps, or iterations of the steady state's equations, estimated relative error of
  /// fluence, relative error of the energy balance, what is left over included, seconds of all
  /// solving (uncollided light, too), the device's name, and what the scene did not need, one per line.
  vtkGetMacro(Steps, int);
  vtkGetMacro(Residual, double);
  vtkGetMacro(BalanceError, double);
  vtkGetMacro(Seconds, double);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  ///@}

protected:
  vtkLatticeBoltzmannLighting();
  ~vtkLatticeBoltzmannLighting() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  void Note(const tyndall::LightField& light) override;
  bool KnowsIndex() const override { return this->Scheme == CONSERVATIVE; }
  std::string NotByBlocks(vtkInformationVector** inputs) const override;
  tyndall::LightField Solve(const tyndall::SolverScene& scene) override;
  int PortOfShares() const override { return PHOTONS; }
  tyndall::IlluminationInput ReadShining(tyndall::SolverScene& scene, vtkInformationVector** inputs) override;

private:
  vtkLatticeBoltzmannLighting(const vtkLatticeBoltzmannLighting&) = delete;
  void operator=(const vtkLatticeBoltzmannLighting&) = delete;

  tyndall::LatticeSettings Settings() const;
  tyndall::LightField LightOf(
    const tyndall::Domain& domain, const tyndall::PreviewScene& scene, const std::vector<tyndall::Photon>* photons);

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
  double Residual = 0.0;
  double BalanceError = 0.0;
  double Seconds = 0.0;
  std::string DeviceName;
  std::string LeftOut;
};

#endif
