"""Surfaces in files as laboratories have them: read right at first try, or refused by name."""

import struct
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import SurfaceTable
from gripscale.case_file.prepare import raw_surface
from gripscale.case_file.proposals import UNITS_OF_SURFACE, open_surface, surface_proposal
from gripscale.core.errors import FileError, GripscaleError, InputError
from gripscale.io.text_table import read_text
from gripscale.surface.read import _topography

HEIGHTS = 1e-3 * np.sin(np.arange(120) / 7.0)
"""Heights of a profile [m] in steps of 0.1 mm, from 0 to 1 mm with six digits."""
STEP = 1e-4


def rows(x=1e-3, z=1e-3, separator=",", form="{:.8g}"):
    """Return distance and height in units of these sizes [m], line by line."""
    lines = zip(STEP * np.arange(120) / x, HEIGHTS / z, strict=True)
    return "\n".join(separator.join(form.format(value) for value in line) for line in lines)


def heights(z=1e-3):
    return "\n".join(f"{value / z:.8g}" for value in HEIGHTS)


US_FOOT = 1200.0 / 3937.0
MINUS_DECIMALS = rows(separator=";", form="{:.6f}").replace(".", ",")
INDEXED = "\n".join(f"{i},{row}" for i, row in enumerate(rows().splitlines()))
TRAILING = "\n".join(f"{row},," for row in rows(1e-6, 1e-6).splitlines())
PROFILES = {
    "feet and mils": "Distance (ft),Height (mils)\n" + rows(0.3048, 2.54e-5),
    "survey feet": "Distance [ftUS],Height [in]\n" + rows(US_FOOT, 0.0254),
    "angstrom": "x (um),Profile (Å)\n" + rows(1e-6, 1e-10),
    "microinch": "x (in),z (uin)\n" + rows(0.0254, 2.54e-8),
    "kilometre": "Station (km);Elevation (mm)\n" + rows(1e3, 1e-3, ";", "{:.9f}"),
    "counts": "distance [mm],height [counts]\n# 1 count = 0.5 um\n" + rows(1e-3, 5e-7),
    "step distance": "Pen: 1000 µ\nX step distance = 0.100 mm\nHeight in mm\n" + heights(),
    "length": "X distance = +11.9 mm\nHeight in mm\n" + heights(),
    "pitch": "Profile height\nunit: um\npitch: 100 um\n" + heights(1e-6),
    "ragged preamble": "Scan Type,Standard\nLocation,0.0 um, 0.0 um\nLength,1 um\n\nScan Data\n"
    "Lateral um,Raw Micrometer,\n" + TRAILING,
    "index": "index, x in µm, y in µm\n"
    + "\n".join(f"{i}, {row}" for i, row in enumerate(rows(1e-6, 1e-6).splitlines())),
    "point numbers": "Point No.,Distance (mm),Height (mm)\n" + INDEXED,
    "quoted decimals": '"x [mm]","z [mm]"\n'
    + "\n".join('"' + row.replace(";", '","') + '"' for row in MINUS_DECIMALS.splitlines()),
    "units behind numbers": "Weg;Hoehe\n"
    + "\n".join(
        f"{x:.4f} mm;{z:.8f} mm".replace(".", ",")
        for x, z in zip(1e3 * STEP * np.arange(120), 1e3 * HEIGHTS, strict=True)
    ),
    "bars": "| x [mm] | z [mm] |\n"
    + "\n".join(f"| {row} |" for row in rows(separator="|").split()),
    "inches as a mark": "Distance (\u2033),Height (mils)\n" + rows(0.0254, 2.54e-5),
    "scale of a digit": "x [mm];z [digits]\n# z scale: 0.25 um/digit\n" + rows(1e-3, 2.5e-7, ";"),
    "microns per count": "Scale factor: 0.25 um per count\nx [mm],z [counts]\n"
    + rows(1e-3, 2.5e-7),
    "points per length": "Sampling: 10 points/mm\nHeight (mm)\n" + heights(),
    "points per length, behind": "Points per mm: 10\nHeight (mm)\n" + heights(),
    "length without a sign": "Traverse length 11.9 mm\nZ (mm)\n" + heights(),
    "Dutch": "Afstand (mm);Hoogte (mm)\n" + rows(separator=";"),
    "Japanese, heights first": "\u9ad8\u3055 (mm),\u8ddd\u96e2 (mm)\n"
    + "\n".join(",".join(row.split(",")[::-1]) for row in rows().splitlines()),
    "a deflection beside": "x [mm],Deflection [mm],Height [mm]\n"
    + "\n".join(f"{row.replace(',', ',0.5,')}" for row in rows().splitlines()),
    "a speed beside": "Distance [mm],Elevation [mm],Speed [km/h]\n"
    + "\n".join(f"{row},60" for row in rows().splitlines()),
    "waviness beside": "Distance [mm],Primary profile [mm],Waviness profile [mm]\n"
    + "\n".join(f"{row},0.1" for row in rows().splitlines()),
    "road profile": "ERDFILEV2.00\n  1, 120, -1, 1, 5, 1.0E-04, -1\nTITLE road\n"
    "LONGNAMEElevation\nUNITSNAMmm\nXUNITS  m\nEND\n" + heights(),
    "kiloangstrom": "Lateral (dm),Height (kÅ)\n" + rows(0.1, 1e-7),
    "units as one letter": "x [㎜],z [㎛]\n" + rows(1e-3, 1e-6),
    "pages": "Distance\tHeight\nmm\tmm\n"
    + rows(separator="\t").replace("\n5\t", "\n\fPage 2\nDistance\tHeight\nmm\tmm\n5\t"),
    "pixels": "x (px),z (um)\n# pixel size: 100 um\n"
    + "\n".join(f"{i},{z / 1e-6:.8g}" for i, z in enumerate(HEIGHTS)),
    "numbers of points": "Pitch, 0.1, mm\nNo.,Height (mm)\n"
    + "\n".join(f"{i},{z / 1e-3:.8g}" for i, z in enumerate(HEIGHTS, start=1)),
    **{
        titles: f"Einheiten: mm\n{titles}\n"
        + "\n".join(f"{time}{row}" for row in rows(separator=";").splitlines())
        for titles, time in (
            ("Zeit [s];Weg;Höhe", "0.01;"),
            ("time [s];Distance;Height", "0.01;"),
            ("Weg;Höhe", ""),
        )
    },
    "step and distances": "Pitch=0.1000\nUnit=mm\n[DATA]\n" + rows(separator=" "),
}


@pytest.mark.parametrize("kind", PROFILES)
def test_a_profile_is_read_at_first_try(written, kind):
    name = "road.erd" if kind == "road profile" else "road.txt"
    profile = gs.read_profile(written(PROFILES[kind], name))
    assert profile.step == pytest.approx(STEP, rel=1e-4)
    np.testing.assert_allclose(profile.z, HEIGHTS, atol=2e-9)


@pytest.mark.parametrize(
    ("titles", "code"),
    [
        ("距離 (mm),高さ (mm)", "cp932"),
        ("Young’s x (mm),Poisson’s z (mm)", "cp1252"),
        ("Länge (mm),Höhe (mm)", "cp1252"),
    ],
)
def test_code_pages(written, titles, code):
    path = written(f"{titles}\n{rows()}\n".encode(code))
    np.testing.assert_allclose(gs.read_profile(path).z, HEIGHTS, atol=2e-9)
    assert read_text(path).startswith(titles)


@pytest.mark.parametrize("code", [0.0, 999.99, -99.99, -9999.0])
def test_codes_far_from_the_road_are_missing(tmp_path, code):
    path = tmp_path / "road.csv"
    z = 1e3 * HEIGHTS + 80.0
    z[[7, 8]] = code
    np.savetxt(path, np.c_[0.1 * np.arange(120), z], delimiter=",", header="x [mm],z [mm]")
    profile = gs.read_profile(path)
    assert np.flatnonzero(np.isnan(profile.z)).tolist() == [7, 8]
    assert profile.notes == (f"heights of {code:g} mm stand for missing ones",)


def test_pairs_of_distances_and_heights(tmp_path):
    path = tmp_path / "road.csv"
    x = 0.1 * np.arange(120)
    columns = np.c_[x, 1e3 * HEIGHTS, 2.0 * x, 1e3 * HEIGHTS]
    np.savetxt(path, columns, delimiter=",", header="x1 [mm],z1 [mm],x2 [mm],z2 [mm]", comments="")
    steps = [gs.read_profile(path, channel=channel).step for channel in (2, 4, "z2")]
    assert steps == pytest.approx([STEP, 2.0 * STEP, 2.0 * STEP])


def test_a_unit_that_is_not_known_is_never_proposed_over(written):
    path = written("x [furlong],z [mm]\n" + rows())
    with pytest.raises(FileError, match="'furlong', which is no known unit of length"):
        open_surface(path, None, UNITS_OF_SURFACE)


@pytest.mark.parametrize("blank", ["\u202f", "\u00a0", " "])
def test_thousands_parted_by_blanks(written, blank):
    lines = rows(z=1e-7, separator=";", form="{:.1f}").replace(".", ",").splitlines()
    parted = [
        line if len(line.partition(";")[2].lstrip("-")) < 6 else f"{line[:-5]}{blank}{line[-5:]}"
        for line in lines
    ]
    path = written("Distance (mm);Hauteur (nm)\n" + "\n".join(parted))
    assert any(blank in line for line in parted)
    np.testing.assert_allclose(gs.read_profile(path).z, 1e-2 * HEIGHTS, atol=1e-10)


@pytest.mark.parametrize("suffix", ["", ".prf", ".xlsx", ".dat"])
def test_a_text_is_one_whatever_its_name(written, suffix):
    path = written("x [mm],z [mm]\n" + rows(), f"road{suffix}")
    np.testing.assert_allclose(gs.read_profile(path).z, HEIGHTS, atol=2e-9)


TRACKS = "Chainage (m),Left (mm),Right (mm)\n" + "\n".join(
    f"{row},{2.0 * float(row.split(',')[1]):.8g}" for row in rows(1.0).splitlines()
)


COUNTED = "\n".join(f"{i},{z / 1e-3:.8g}" for i, z in enumerate(HEIGHTS))
TIMES = r"holds times, no distances: give step.*speed"
COLUMNS = "got 2 'Left', 3 'Right'; give channel"
NEEDY = {
    "numbers of points": ("Point,Height (mm)\n" + COUNTED, {"step": STEP},
                          "column 1, Point, counts points, no dist", "step"),
    "counts": ("x [mm],z [counts]\n" + rows(1e-3, 5e-7), {"z_unit": "0.5 um"},
               "column 2 is in 'counts', which is no known unit", ""),
    "times": ("Time (s),Height (mm)\n" + rows(1.0), {"step": STEP}, TIMES, "step"),
    "times without a unit": ("time,z_mm\n" + rows(1.0), {"step": STEP}, TIMES, "step"),
    "two tracks": (TRACKS, {"channel": "Left"}, COLUMNS, "channel"),
    "two tracks, by number": (TRACKS, {"channel": 2}, COLUMNS, "channel"),
    **{
        title: (f"x [mm],{title}\n{rows()}", {}, "which is no known unit of length", "")
        for title in ("z [10^-3 mm]", "z 10^-3 [mm]", "z [x10^-3 mm]", "z x10^-3 [mm]")
    },
}  # fmt: skip
"""Text, what it leaves out, what the refusal says, and the key that it asks for."""


@pytest.mark.parametrize("kind", NEEDY)
def test_what_a_file_leaves_out_is_asked_for(written, kind):
    text, options, words, missing = NEEDY[kind]
    path = written(text)
    with pytest.raises(FileError, match=words) as refused:
        gs.read_profile(path)
    assert refused.value.missing == missing
    if options:
        profile = gs.read_profile(path, **options)
        np.testing.assert_allclose(profile.z, HEIGHTS, atol=2e-9)
        assert "channel" in options or profile.step == pytest.approx(STEP)


def test_one_of_several_columns_of_heights(written):
    path = written(TRACKS)
    for channel in ("Right", 3):
        found = gs.read_profile(path, channel=channel)
        np.testing.assert_allclose(found.z, 2.0 * HEIGHTS, atol=2e-9)
    with pytest.raises(InputError, match="channel"):
        gs.read_profile(path, channel="Middle")


def test_uneven_distances_are_put_on_equal_steps_and_said(tmp_path):
    x = np.sort(np.random.default_rng(3).uniform(0.0, 100.0, 2000))
    path = tmp_path / "road.csv"
    np.savetxt(path, np.c_[x, np.sin(x)], delimiter=",", header="x [mm],z [mm]")
    profile = gs.read_profile(path)
    assert profile.step == pytest.approx(np.diff(x).mean() * 1e-3)
    # a line over distances up to h misses a sine of 1 rad/mm by h^2/8, and gaps are missing
    measured = np.isfinite(profile.z)
    assert measured.mean() > 0.85  # a share of 5 exp(-4) lies in longer gaps
    error = np.abs(1e3 * profile.z - np.sin(1e3 * profile.x))[measured]
    assert error.max() < (4.0 * np.diff(x).mean()) ** 2 / 8.0 + 1e-6
    assert "uneven steps of" in profile.notes[0]
    assert "straight lines" in profile.notes[1]


MAP = 1e-5 * np.random.default_rng(1).standard_normal((20, 24))
"""Heights of a map [m], rows along y."""


def table(size, form="{:.8g}", separator="\t"):
    return "\n".join(separator.join(form.format(z / size) for z in row) for row in MAP)


MAPS = {
    "sides": "# Width: 2.400 mm\n# Height: 2.000 mm\n# Value units: m\n" + table(1.0),
    "scan size": "Scan size: 2.4 mm x 2.0 mm\nData unit: nm\n" + table(1e-9),
    "calibration": '"XY calibration","100.0","um"\n"Horizontal","24"\n"Unit","um"\n\n"Height"\n'
    + table(1e-6, '"{:.6f}"', ","),
    "factor": "h=20 w=24\npixel size=1.0e-004 m\ndata unit=rad\n"
    "height conversion factor (-> m)=6.3e-008\n" + table(6.3e-8),
    "a title of all": "X resolution (mm),0.1\nZ (nm)\n" + table(1e-9, separator=","),
    "pixels": "Pixel width: 100 um\nPixel height: 100 um\nz unit: nm\n" + table(1e-9),
    "two separators": "Pixel Size:,100,um\nZ Unit:,nm\n" + table(1e-9, separator=","),
    "German": '"XY-Kalibrierung";"100,0";"µm"\n"Einheit";"µm"\n\n"Höhe"\n'
    + table(1e-6, "{:.8f}", ";").replace(".", ","),
    "Japanese": "XYキャリブレーション,100.0,um\n単位,um\n\n高さ\n" + table(1e-6, "{:.8f}", ","),
    "Zygo": 'Zygo XYZ Data File - Format 1\n0 3 0 0 "Tue"\n0 0 24 20 1 255\n0 0 24 20\n\n\n\n'
    '0 0 6.328e-07 0.5 1 0 1.0e-4 1787677163\n3 2 0 0 0 66 0 ""\n0 1 100 0\n0 ""\n1 5 0\n#\n'
    + "\n".join(f"{i} {j} {z / 1e-6:.8g}" for j, row in enumerate(MAP) for i, z in enumerate(row))
    + "\n#\n",
}


@pytest.mark.parametrize("kind", MAPS)
def test_a_map_is_read_at_first_try(written, kind):
    surface = gs.read_map(written(MAPS[kind], "map.txt"))
    assert surface.x[1] - surface.x[0] == pytest.approx(1e-4)
    assert surface.y[1] - surface.y[0] == pytest.approx(1e-4)
    np.testing.assert_allclose(surface.z, MAP.T, atol=2e-12)


def test_distances_at_the_edge_of_a_table_are_no_heights(written):
    lines = table(1e-3, separator=",").split("\n")
    titles = "y/x," + ",".join(f"{0.1 * i:.1f}" for i in range(24))
    path = written("\n".join([titles, *(f"{0.1 * j:.1f},{line}" for j, line in enumerate(lines))]))
    with pytest.raises(FileError, match="column 1, which goes in equal steps"):
        gs.read_map(path, step=1e-4, z_unit="mm")


def test_a_simple_field_of_gwyddion(written):
    sizes = "XRes = 24\nYRes = 20\nXReal = 0.0024\nYReal = 0.002\nXYUnits = m\nZUnits = nm\n"
    head = f"Gwyddion Simple Field 1.0\n{sizes}".encode()
    head += bytes(4 - len(head) % 4)
    heights = (1e9 * MAP).astype("<f4").tobytes()
    surface = gs.read_map(written(head + heights, "map.gsf"))
    assert surface.step == pytest.approx((1e-4, 1e-4))
    np.testing.assert_allclose(surface.z, MAP.T, rtol=1e-6)
    with pytest.raises(FileError, match="expected a simple field of Gwyddion"):
        gs.read_map(written(head + heights[:-4], "map.gsf"))


@pytest.mark.parametrize("name", ["map.sdf", "map.txt"])
def test_a_map_with_a_trailer(written, name):
    head = "aISO-1.0\nNumPoints = 24\nNumProfiles = 20\nXscale = 1e-4\nYscale = 1e-4\nZscale = 1e-6"
    text = f"{head}\n*\n{table(1e-6)}\n*\n< PartName > plate 2 < /PartName >\n*\n"
    path = written(text, name)
    np.testing.assert_allclose(gs.read_map(path).z, MAP.T, atol=2e-12)


@pytest.mark.parametrize(
    "titles",
    [
        "q (1/m),C (m^4)",
        "Spatial frequency (1/m),Power spectral density (m^3)",
        "Wavelength,PSD",
        "wavenumber q [1/m],areal spectrum C(q) [m^4]",
    ],
)
def test_a_spectrum_is_named_as_one(tmp_path, titles):
    path = tmp_path / "spectrum.csv"
    q = np.geomspace(50.0, 1e5, 80)
    np.savetxt(path, np.c_[q, q**-3.6], delimiter=",", header=titles)
    with pytest.raises(GripscaleError, match="power spectrum of a surface"):
        gs.read_profile(path)


def test_tracks_are_profiles_of_one_surface(written):
    path = written(TRACKS, "road.csv")
    keys = surface_proposal([path], [str(path)]).keys
    assert keys["channel"] == ["Left", "Right"]
    left, right = raw_surface(SurfaceTable(**keys))
    assert (left.name, right.name) == ("road Left", "road Right")
    np.testing.assert_allclose(left.z, HEIGHTS, atol=2e-9)
    np.testing.assert_allclose(right.z, 2.0 * HEIGHTS, atol=2e-9)


@pytest.mark.parametrize("name", ["map.nms", "map", "map.dat"])
def test_an_instrument_file_is_known_without_its_name(written, name):
    """The layout of NanoFocus has no first bytes of its own: numbers at fixed places."""
    low, high = float(MAP.min()), float(MAP.max())
    head = bytearray(3468)
    struct.pack_into("<dd", head, 16, 1e6 * low, 1e6 * high)  # um
    struct.pack_into("<IIdd", head, 1368, *MAP.T.shape, 0.1, 0.1)  # mm
    levels = np.rint((MAP - low) / (high - low) * 65534).astype("<u2")
    pytest.importorskip("SurfaceTopography")
    surface = gs.read_map(written(bytes(head) + levels.tobytes(), name))
    assert surface.x[1] - surface.x[0] == pytest.approx(1e-4)
    np.testing.assert_allclose(surface.z, MAP.T, atol=(high - low) / 65534)


def test_deflections_are_no_heights_of_an_instrument():
    channels = [
        SimpleNamespace(
            name=name, index=at, is_height_channel=True, physical_sizes=(1.0, 1.0), topography=str
        )
        for at, name in enumerate(("Deflection Error", "Height Sensor"))
    ]
    taken = []
    for channel in channels:
        channel.topography = lambda name=channel.name: taken.append(name)
    _topography(Path("scan.spm"), channels, None, None)
    _topography(Path("scan.spm"), channels, "Deflection Error", None)
    assert taken == ["Height Sensor", "Deflection Error"]
