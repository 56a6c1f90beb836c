#pragma once

/// Plane-parallel slabs: total flux reflected and transmitted over the flux that comes in. Isotropic scattering, black
/// surroundings, no refraction. High-order adding-doubling, agrees with DISORT and van de Hulst's tables to 1e-7 or
/// better; rows of the project's table of reference values (slab.csv), copied so that a clone needs no other file.
struct SlabReference
{
  double tau, albedo;
  double diffuseR, diffuseT; ///< isotropic light on one face
  double beamR, beamT;       ///< a beam across the slab
};

constexpr SlabReference SlabReferences[] = {
  { 0.1, 0.5, 3.84326704e-02, 8.70437851e-01, 2.17329877e-02, 9.26465100e-01 },
  { 1.0, 0.5, 1.34165166e-01, 3.06708824e-01, 9.91191855e-02, 4.46058390e-01 },
  { 1.0, 0.9, 3.52712040e-01, 4.74745855e-01, 2.67410335e-01, 5.91625090e-01 },
  { 1.0, 0.999, 4.45516364e-01, 5.52486822e-01, 3.40476302e-01, 6.57890379e-01 },
  { 5.0, 0.99, 7.37506992e-01, 1.73152245e-01, 6.80078115e-01, 2.20627797e-01 },
};
