"""The cubes of ./run bench peers: unit cubes whose face z = 0 shines, unit flux, evenly in all directions."""
import numpy

BLOCKS = 8       # a side, of which fluence is compared
CLOUD_VOXELS = 32


def cloud():
    """Extinction with a spectrum like turbulence's, mean 20, largest over smallest 30, [z][y][x]."""
    waves = numpy.fft.fftfreq(CLOUD_VOXELS) * CLOUD_VOXELS
    square = waves[:, None, None] ** 2 + waves[None, :, None] ** 2 + waves[None, None, :] ** 2
    noise = numpy.random.RandomState(16).standard_normal((CLOUD_VOXELS,) * 3)  # the same in every version of NumPy
    spectrum = numpy.fft.fftn(noise) / (1.0 + square) ** (11.0 / 12.0)
    spectrum[0, 0, 0] = 0.0
    field = numpy.fft.ifftn(spectrum).real
    field = 30.0 ** ((field - field.min()) / (field.max() - field.min()))
    return 20.0 * field / field.mean()


# name: title, extinction in 1/length ([z][y][x]), albedo
SCENES = {
    "cube-5": ("cube, tau 5, albedo 0.9", numpy.full((1, 1, 1), 5.0), 0.9),
    "cloud-20": ("cloud of contrast 30, mean tau 20, albedo 0.99", cloud(), 0.99),
    "cube-100": ("cube, tau 100, albedo 0.99", numpy.full((1, 1, 1), 100.0), 0.99),
}
