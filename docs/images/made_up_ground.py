#!/usr/bin/env python3
"""A made-up ground as a base map: hills in relief, woods, fields and a river, as a GeoTIFF.

Nothing in it is real, so it belongs to nobody; docs/images/base-map.png has it under the sample fleet.

    python3 docs/images/made_up_ground.py ground.tif 15.52 48.37 15.70 48.46    # west south east north

Needs numpy and GDAL's Python (packages python3-numpy, python3-gdal).
"""

import sys

import numpy as np
from osgeo import gdal, osr

WIDTH_PX = 3000
SUN_AZIMUTH_DEG, SUN_HEIGHT_DEG = 315, 45
FIELDS = np.array([[232, 227, 190], [214, 221, 172], [240, 232, 208], [224, 214, 170], [203, 214, 160]])
WOOD, MEADOW, WATER = np.array([138, 176, 124]), np.array([208, 222, 178]), np.array([150, 193, 219])
M_PER_DEG = 6378137 * np.pi / 180


def rough(shape, longest_px, slope, random):
    """A random surface whose waves are the higher the longer they are, up to a longest; of size 1."""
    waves = np.fft.rfft2(random.standard_normal(shape))
    y, x = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :]
    surface = np.fft.irfft2(waves / np.maximum(np.hypot(x, y), 1 / longest_px) ** slope, shape)
    return (surface - surface.mean()) / surface.std()


def shaded(height_px):
    """Lambert's shading with the sun in the north-west, 1 on the flat."""
    down, right = np.gradient(height_px)
    azimuth, height = np.radians(SUN_AZIMUTH_DEG), np.radians(SUN_HEIGHT_DEG)
    east, north, up = np.sin(azimuth) * np.cos(height), np.cos(azimuth) * np.cos(height), np.sin(height)
    light = (-right * east + down * north + up) / np.sqrt(1 + down**2 + right**2) / up
    return np.clip(light, 0.45, 1.2)


def ground(shape, random):
    y, x = np.mgrid[0 : shape[0], 0 : shape[1]]
    bends = rough((1, shape[1]), 2500, 2.5, random)[0]
    from_river = np.abs(y - shape[0] * 0.635 - 28 * bends)
    valley = np.clip((from_river - 90) / 700, 0, 1) ** 1.3
    height = valley * (150 + 75 * rough(shape, 900, 2.1, random))

    turned_y, turned_x = y + 0.35 * x + 12 * rough(shape, 400, 2, random), x - 0.35 * y
    row = turned_y // 46
    field = (turned_x + 40 * (row * 7 % 5)) // 120
    colour = FIELDS[((field * 7 + row * 13 + field * row) % len(FIELDS)).astype(int)].astype(float)
    colour[rough(shape, 300, 1.8, random) > 0.9] = MEADOW
    colour[height + 25 * rough(shape, 200, 1.8, random) > 125] = WOOD
    colour[from_river < 58] = MEADOW
    colour *= shaded(height)[:, :, None]
    colour[from_river < 36] = WATER
    return np.clip(colour, 0, 255).astype(np.uint8)


def main(file, west, south, east, north):
    mercator = lambda lat: np.degrees(np.arcsinh(np.tan(np.radians(lat))))
    per_px = (east - west) / WIDTH_PX * M_PER_DEG
    height_px = round((mercator(north) - mercator(south)) / (east - west) * WIDTH_PX)
    pixels = ground((height_px, WIDTH_PX), np.random.default_rng(11))
    system = osr.SpatialReference()
    system.ImportFromEPSG(3857)
    raster = gdal.GetDriverByName("MEM").Create("", WIDTH_PX, height_px, 3)
    raster.SetProjection(system.ExportToWkt())
    raster.SetGeoTransform([west * M_PER_DEG, per_px, 0, mercator(north) * M_PER_DEG, 0, -per_px])
    raster.SetMetadataItem("TIFFTAG_COPYRIGHT", "made up")
    for band in range(3):
        raster.GetRasterBand(band + 1).WriteArray(pixels[:, :, band])
    gdal.GetDriverByName("COG").CreateCopy(file, raster, options=["COMPRESS=DEFLATE"])


if __name__ == "__main__":
    main(sys.argv[1], *map(float, sys.argv[2:]))
