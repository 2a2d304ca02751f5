"""Each figure shows the numbers it was given, in the units its labels state."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.markers import TICKDOWN

from gripscale.charts import save_figure
from gripscale.charts.chart import Outline, Panel, PlotAxis, Series
from gripscale.charts.draw import FigureFolder, Sheet
from gripscale.charts.paper import figure_file
from gripscale.charts.style import short_number, stretches
from gripscale.core.errors import FileError, InputError
from gripscale.questions import (
    block_figure,
    blocks_figure,
    contact_figure,
    correlation_figure,
    master_curve_figure,
    profile_figure,
)
from gripscale.questions.compare import charts as ladder
from gripscale.questions.compare.charts import Row, comparison_figure
from gripscale.questions.inputs.record import envelope, sine_curves
from gripscale.rubber import MasterCurve, Rubber, fit_prony_report
from gripscale.surface import Profile, SelfAffineFit, SineStack, clean, height_difference

STACK = SineStack(wavelength=[20e-3, 5e-3], amplitude=[2e-3, 0.5e-3])


def spiky():
    x = np.arange(2000) * 1e-4
    z = 2e-3 * np.cos(2 * np.pi * x / 20e-3) + 0.5e-3 * np.cos(2 * np.pi * x / 5e-3 + 1.0)
    z[100:110] = np.nan
    z[500] += 5e-3
    return Profile(x, z, name="two waves")


def curve(axes, label):
    line = next(line for line in axes.lines if line.get_label() == label)
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def complete(figure):
    """Every axes has data and, on the outside, labels with units."""
    assert figure.axes
    for axes in figure.axes:
        assert axes.lines or axes.collections
    labels = [axes.get_xlabel() for axes in figure.axes] + [a.get_ylabel() for a in figure.axes]
    assert all("[" in label for label in labels if label)
    assert sum(bool(label) for label in labels) >= 2
    figure.draw_without_rendering()


def dashed(axes):
    """Return the curves that are drawn dashed, the entry of the legend left out."""
    return [line for line in axes.lines if line.get_gid() and line.get_xdata().size]


def labels(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_what_is_beyond_the_band_is_dashed_and_the_legend_says_so(make_prediction):
    data = make_prediction()
    inside = contact_figure({"dynamic": data})
    assert not any(dashed(axes) for axes in inside.axes)
    assert "beyond the measured band" not in labels(inside)
    data["outside_band"].values[:] = [0, 1, 0]
    figure = contact_figure({"dynamic": data})
    complete(figure)
    assert labels(figure).count("beyond the measured band") == 1
    for axes in figure.axes:
        running, each = dashed(axes)
        # from the second wave on the sum rests on it; of the waves alone only what joins it
        assert running.get_xdata().tolist() == [20.0, 5.0, 1.25]
        assert each.get_xdata().tolist() == [20.0, 5.0, 1.25]
        assert running.get_linestyle() == "--"


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        ([0, 0, 1, 1], [(0, 2, False), (1, 4, True)]),
        ([1, 0, 0, 0, 1], [(0, 2, True), (1, 4, False), (3, 5, True)]),
        ([0, 0], [(0, 2, False)]),
        ([1], [(0, 1, True)]),
    ],
)
def test_a_curve_is_cut_where_the_band_ends(flags, expected):
    assert [(part.start, part.stop, beyond) for part, beyond in stretches(flags)] == expected


def test_contact_is_drawn_against_falling_wavelength_in_mm(make_prediction):
    figure = contact_figure({"dynamic": make_prediction(), "static": make_prediction(speed=0.0)})
    complete(figure)
    area, friction = figure.axes
    x, y = curve(area, "dynamic, running total")
    np.testing.assert_allclose(x, [20.0, 5.0, 1.25])
    np.testing.assert_allclose(y, [0.5, 0.25, 0.125])
    np.testing.assert_allclose(curve(area, "static, each wave")[1], 0.5)
    np.testing.assert_allclose(curve(friction, "dynamic, running total")[1], [0.1, 0.2, 0.3])
    assert len(friction.lines) == 2  # nothing of the chain at rest
    low, high = area.get_ylim()
    assert 0.05 < low < 0.125  # the smallest number shown, with little below it
    assert high == 1.15
    left, right = area.get_xlim()
    assert left > 20.0
    assert right < 1.25


def test_failed_wave_is_not_drawn_as_a_result(make_prediction):
    figure = contact_figure({"dynamic": make_prediction(status="iteration limit")})
    for label in ("dynamic, running total", "dynamic, each wave"):
        assert np.isnan(curve(figure.axes[0], label)[1]).tolist() == [False, False, True]


def test_model_without_waves_is_a_level_line(make_prediction, without_waves):
    figure = contact_figure({"chain": make_prediction(), "toy": without_waves})
    complete(figure)
    assert set(curve(figure.axes[0], "toy, total")[1]) == {0.05}
    assert set(curve(figure.axes[1], "toy, total")[1]) == {0.6}
    alone = contact_figure({"toy": without_waves})
    alone.draw_without_rendering()
    assert [len(axes.lines) for axes in alone.axes] == [1, 1]
    assert blocks_figure(without_waves).axes == []


@pytest.mark.parametrize("lifted", [0.0, 1.0])
def test_block_touches_its_wave_under_its_pressure(make_wave, lifted):
    """Set down on it, if the mesh is lifted; the pressure is that of one closed period."""
    figure = block_figure(make_wave(4e-3, lifted=lifted))
    complete(figure)
    above, block = figure.axes
    x, pressure = above.lines[0].get_data()
    assert [x[0], x[-1]] == [-0.5, 0.5]
    assert (np.diff(x) >= 0.0).all()
    assert pressure[0] == pressure[-1]
    expected = np.maximum(np.cos(2 * np.pi * np.asarray(x)), 0.0)  # MPa
    np.testing.assert_allclose(pressure, expected, atol=1e-12)
    x, z = curve(block, "surface")
    assert x.min() <= -0.5
    assert x.max() >= 0.5
    np.testing.assert_allclose(z, 0.1, rtol=1e-9)  # the crest
    frame = block.get_window_extent()
    scale = frame.height / np.ptp(block.get_ylim()), frame.width / np.ptp(block.get_xlim())
    assert scale[0] == pytest.approx(scale[1], rel=1e-9)  # to scale
    x, z = curve(block, "mesh")
    known = np.isfinite(x)
    levels = 0.1 + np.linspace(0.0, 1.5, 7)
    off_line = np.abs(x[known] * 32 - np.round(x[known] * 32))
    assert np.minimum(off_line, np.abs(z[known][:, None] - levels).min(axis=1)).max() < 1e-9
    assert z[known].max() > block.get_ylim()[1]  # up to the edge
    assert (np.count_nonzero(~known)) >= 32 + 4  # a gap after each line


@pytest.mark.parametrize("count", [1, 5])
def test_every_wave_has_its_block(make_prediction, count):
    figure = blocks_figure(make_prediction(count=count))
    complete(figure)
    assert len(figure.axes) == 2 * count
    with pytest.raises(InputError, match=f"from 1 to {count}; got {count + 1}"):
        block_figure(make_prediction(count=count), count + 1)
    assert [a.get_title(loc="left") for a in figure.axes[::2]] == [
        f"λ = {20 / 4.0**i:.3g} mm\nA = {2 / 4.0**i:.3g} mm\np = 0.3 MPa, contact 0.50"
        for i in range(count)
    ]


def test_correlation_shows_measured_band_and_fits():
    profile, _ = clean(spiky())
    measured = height_difference(profile)
    fit = SelfAffineFit(0.8, 5e-3, 2e-3, 1e-4, 1e-3, 0.01)
    figure = correlation_figure(measured, {"2 sine waves": STACK}, fit)
    complete(figure)
    axes = figure.axes[0]
    x, y = curve(axes, "measured")
    np.testing.assert_allclose(x, measured.lag * 1e3)
    np.testing.assert_allclose(y, measured.value * 1e6)
    x, y = curve(axes, "self-affine, $H$ = 0.80")
    np.testing.assert_allclose(y[x > 5.0], 4.0)  # the plateau xi_perp^2 = 4 mm^2
    x, y = curve(axes, "2 sine waves")
    below = x < 5.0
    np.testing.assert_allclose(y[below], STACK.height_difference(x[below] * 1e-3) * 1e6)
    assert x.max() <= 20.0
    assert curve(axes, "their wavelengths")[0].tolist() == [20.0, 5.0]


def test_master_curve_shows_points_series_and_excitation():
    omega = np.geomspace(1e-1, 1e5, 40)
    modulus = Rubber(5e6, [4e6, 8e6], [1e-2, 1e-4]).complex_modulus(omega)
    storage, loss = modulus.real.copy(), modulus.imag.copy()
    storage[20] *= 3.0
    master = MasterCurve(omega / (2 * np.pi), storage, loss)
    rubber, fit = fit_prony_report(master)
    assert len(fit.outlier_frequency) == 1
    figure = master_curve_figure(rubber, master, fit, [10.0, 100.0])
    complete(figure)
    moduli, _ = figure.axes
    assert curve(moduli, "$E'$, measured")[0].size == 39
    x, y = curve(moduli, "$\\omega_i$ of the waves")
    assert x.tolist() == [10.0, 100.0]
    np.testing.assert_allclose(y, rubber.complex_modulus(x).real / 1e6)
    x, _ = curve(moduli, "$E'$, Prony series")
    band = rubber.valid_band
    assert (x.min(), x.max()) == pytest.approx(band, rel=0.05)  # beyond it, dashed
    assert len(dashed(moduli)) == 4
    assert labels(figure).count("beyond the measured band") == 1
    assert len(moduli.collections) >= 2  # what the data leave open, shaded


def test_envelope_keeps_extremes_and_gaps():
    z = np.array([1.0, 3.0, np.nan, 2.0, np.nan, np.nan, 5.0, 4.0])
    middle, lowest, highest = envelope(np.arange(8.0), z, 4)
    assert middle.tolist() == [0.5, 2.5, 4.5, 6.5]
    np.testing.assert_array_equal(lowest, [1.0, 2.0, np.nan, 4.0])
    np.testing.assert_array_equal(highest, [3.0, 2.0, np.nan, 5.0])
    along, heights = Outline(middle, lowest, highest).drawn(4)
    np.testing.assert_array_equal(along[:4], [0.5, 0.5, 2.5, 2.5])
    np.testing.assert_array_equal(heights, [1.0, 3.0, 2.0, 2.0, np.nan, np.nan, 4.0, 5.0])
    np.testing.assert_array_equal(
        Outline(middle, lowest, highest).drawn(2)[1], [1.0, 3.0, 4.0, 5.0]
    )
    few = envelope([0.0, 1.0], [7.0, 8.0], 3)
    np.testing.assert_array_equal(few, [[0.0, 1.0, np.nan], [7.0, 8.0, np.nan], [7.0, 8.0, np.nan]])


def test_first_wave_counts_by_its_mean_beyond_a_quarter_of_its_length():
    fitted, pure = sine_curves(STACK, [2e-3, 10e-3, 21e-3])
    np.testing.assert_allclose(pure[:2], STACK.height_difference([2e-3, 10e-3]), rtol=1e-14)
    assert fitted[0] == pytest.approx(pure[0], rel=1e-14)
    second = 2.0 * np.sin(np.pi * 10.0 / 5.0) ** 2 * 0.5e-3**2
    assert fitted[1] == pytest.approx(2e-3**2 + second, rel=1e-12)
    assert np.isnan([fitted[2], pure[2]]).all()


def test_profile_shows_what_cleaning_removed():
    raw = spiky()
    cleaned, _ = clean(raw, crop=(10e-3, 190e-3))
    figure = profile_figure([(raw, cleaned), (raw, cleaned)])
    complete(figure)
    assert len(figure.axes) == 4
    shown = figure.axes[2].lines[0].get_ydata() * 1e-3
    assert np.nanmax(shown) <= np.nanmax(cleaned.z) < np.nanmax(raw.z)
    assert labels(figure) == ["as read", "cleaned", "cleaned, every point"]


def test_a_figure_is_saved_as_each_kind_and_leaves_matplotlib_alone(tmp_path, make_wave):
    before = dict(mpl.rcParams)
    paths = save_figure(block_figure(make_wave(4e-3)), tmp_path, "block")
    assert [path.suffix for path in paths] == [".png", ".pdf"]
    assert [path.read_bytes()[:4] for path in paths] == [b"\x89PNG", b"%PDF"]
    sheet = Sheet([Panel(PlotAxis("$x$ [mm]"), PlotAxis("height [mm]"), [Series([0, 1], [0, 1])])])
    (tmp_path / "all").mkdir()
    FigureFolder(tmp_path / "all", ("png", "pdf", "svg")).save(sheet, "sheet")
    FigureFolder(tmp_path / "all").save(sheet.on_paper(), "drawn")
    written = {path.name: path.read_bytes() for path in (tmp_path / "all").iterdir()}
    assert set(written) == {"sheet.png", "sheet.pdf", "sheet.svg", "drawn.png"}
    assert written["sheet.png"] == written["drawn.png"]
    assert b"height [mm]" in written["sheet.svg"]
    assert dict(mpl.rcParams) == before
    with pytest.raises(FileError, match=r"nowhere/sheet\.png cannot be written"):
        FigureFolder(tmp_path / "nowhere").save(sheet, "sheet")


def test_logarithmic_axes_are_marked_between_the_powers_of_ten_once(tmp_path, make_prediction):
    figure = contact_figure({"dynamic": make_prediction()})
    for _ in range(2):
        save_figure(figure, tmp_path, "contact")
    marks = [line for line in figure.artists if line.get_marker() == TICKDOWN]
    assert len(marks) == 2  # below each panel
    wavelength = np.asarray(marks[0].get_xdata())
    low, high = sorted(figure.axes[0].get_xlim())
    expected = [m * 10.0**n for n in (-1, 0, 1) for m in range(2, 10)]
    np.testing.assert_allclose(wavelength, [x for x in expected if low <= x <= high])


@pytest.mark.parametrize("low", np.geomspace(0.1, 1.0, 7))
@pytest.mark.parametrize("ratio", [1.8, 3.2, 5.0, 7.9])
def test_a_short_logarithmic_axis_has_three_numbers(low, ratio):
    panel = Panel(
        PlotAxis("x"), PlotAxis("y", True, low, ratio * low), [Series([0, 1], [low, ratio * low])]
    )
    axes = Sheet([panel]).on_paper().axes[0]
    ticks = np.asarray(axes.get_yticks())
    assert ((ticks >= low) & (ticks <= ratio * low)).sum() >= 3


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.001, "0.001"), (2.5, "2.5"), (1e4, "10000"), (1e-5, "10⁻⁵"), (2e12, "2·10¹²"), (0.0, "0")],
)
def test_numbers_of_axes_stay_short(value, text):
    assert short_number(value) == text


def inside(figure):
    """Nothing that is drawn reaches beyond the figure, where it would be cut."""
    figure.draw_without_rendering()
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    assert box.x0 > -0.01
    assert box.y0 > -0.01
    assert box.x1 < width + 0.01
    assert box.y1 < height + 0.01


@pytest.mark.parametrize("band", [(1e-2, 1e6), (1e-9, 1e15), None])
def test_ends_of_the_band_are_marked_and_named_and_nothing_is_cut(band):
    rubber = Rubber(5e6, [4e6, 8e6], [1e-2, 1e-4], valid_band=band)
    figure = master_curve_figure(rubber, excitation=[10.0])
    named = labels(figure).count("ends of the measured band")
    assert named == (band is not None)
    for axes in figure.axes:
        upright = [line.get_xdata()[0] for line in axes.lines if len(set(line.get_xdata())) == 1]
        assert [x for x in upright if x != 10.0] == pytest.approx(list(band or ()))
    assert all(axes.get_legend() is None for axes in figure.axes)  # none lies over data
    inside(figure)


def test_run_without_a_solution_says_so_and_shows_no_numbers(make_prediction):
    """One wave, failed: an ordinary panel without contact, and a legend that says why."""
    failed = make_prediction(0.0, "element inverted", count=1)
    figure = blocks_figure(failed)
    above, below = figure.axes
    title = above.get_title(loc="left")
    assert "contact" not in title
    assert "element inverted" in title.replace("\n", " ")
    assert [text.get_text() for text in above.texts] == ["no solution"]
    assert not [line for line in below.lines if line.get_label() in ("mesh", "surface")]
    full = blocks_figure(make_prediction(count=4)).axes[0].get_position().width * 7.0
    own = above.get_position().width * figure.get_size_inches()[0]
    assert own == pytest.approx(full)
    inside(figure)
    good = make_prediction()
    named = labels(contact_figure({"dynamic": good, "static": failed}))
    assert [one for one in named if one.startswith("static")] == ["static: element inverted"]


def test_a_legend_of_long_names_stays_inside_the_figure():
    names = [
        "chain of the upper half, pressure in classes",
        "direct contact, random phases",
        "direct contact, sine waves of the chain",
        "direct contact, measured surface",
    ]
    panel = Panel(
        PlotAxis("x"), PlotAxis("y"), [Series([0, 1], [0, 1], label=name) for name in names]
    )
    figure = Sheet([panel, panel]).on_paper()
    figure.canvas.draw()
    box, whole = figure.legends[0].get_window_extent(), figure.bbox
    assert box.x0 >= whole.x0
    assert box.x1 <= whole.x1


def test_numbers_of_a_comparison_end_before_its_factors(monkeypatch):
    rows = [
        Row("chain of the upper half, pressure in classes", 0.0066),
        Row("sines", 0.0091, 0.0, 0.0066, 1.37, samples=(0.0043, 0.0118)),
    ]
    monkeypatch.setattr(ladder, "rows_of", lambda comparison, name: rows)
    names = {"model": ["chain", "sines"], "label": ("model", ["chain", "sines"])}
    data = xr.Dataset({"nominal_speed": 0.3, "group": ("model", ["measured"] * 2)}, names)
    figure = comparison_figure(data)
    figure_file(figure)
    for axes in figure.axes:
        right = axes.get_window_extent().x1
        texts = {text.get_text(): text.get_window_extent() for text in axes.texts}
        assert texts["0.0091"].x1 < right < texts["×1.37"].x0
