#pragma once

/// A plane-parallel slab of Data/Reference/slab.csv: total flux reflected and transmitted over the flux that comes in.
/// Isotropic scattering, black surroundings, no refraction. High-order adding-doubling, agrees with DISORT and van de
/// Hulst's tables to 1e-7 or better.
struct SlabReference
{
  double tau, albedo;
  double diffuseR, diffuseT; ///< isotropic light on one face
  double beamR, beamT;       ///< a beam across the slab
  double obliqueT;           ///< a beam at cosine 0.5 to the slab's normal
};

/// @throws std::runtime_error where the table does not have it
SlabReference SlabOf(double tau, double albedo);

/// Diffuse light through a slab of albedo 1, thicker than some ten mean free paths: the diffusion limit,
/// 4 / (3 (tau + 2 q)), with the extrapolation length q of the Milne problem (Data/Reference/hopf.csv).
double ThickSlabTransmittance(double tau);

/// A beam through it at cosine mu to its normal: H(mu) / (sqrt(3) (tau + 2 q)), with Chandrasekhar's H for albedo 1.
double ThickSlabBeamTransmittance(double tau, double mu);

/// Chandrasekhar's function for isotropic scattering, from the table Data/Reference/chandrasekhar_H.csv.
/// @throws std::runtime_error where the table does not have it
double ChandrasekharH(double albedo, double mu);
