# SPDX-License-Identifier: Apache-2.0
"""Parts and bands of a surface: part=, band= and scale_to_tis= wherever a file is opened."""
import numpy as np
import pytest

import burnish

BLOCKS = {
    ("Reflection Front", "Visible"): 0.1,
    ("Transmission Front", "Visible"): 0.02,
    ("Transmission Front", "NIR"): 0.05,
    ("Transmission Back", "Visible"): 0.03,
}


@pytest.fixture
def sheet(tmp_path):
    """A window's file of one patch a hemisphere, another value for each part and band."""
    blocks = "".join(
        f"<WavelengthData><Wavelength>{band}</Wavelength><WavelengthDataBlock><WavelengthDataDirection>{part}"
        "</WavelengthDataDirection><ColumnAngleBasis>One</ColumnAngleBasis><RowAngleBasis>One</RowAngleBasis>"
        f"<ScatteringData>{value}</ScatteringData></WavelengthDataBlock></WavelengthData>"
        for (part, band), value in BLOCKS.items()
    )
    file = tmp_path / "sheet.xml"
    file.write_text(
        "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure>"
        "<AngleBasis><AngleBasisName>One</AngleBasisName><AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>0"
        "</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock></AngleBasis></DataDefinition>"
        f"{blocks}</Layer></Optical></WindowElement>"
    )
    return file


WI = np.array([[0.0, 0.6, 0.8]])
ABOVE, BELOW = np.array([[0.6, 0.0, 0.8]]), np.array([[0.6, 0.0, -0.8]])


def test_a_part_is_opened_by_its_name(sheet):
    reflection = burnish.open_source(sheet)
    assert reflection.eval(WI, ABOVE) == pytest.approx(0.1)
    for (part, band), value in BLOCKS.items():
        opened = burnish.open_source(sheet, part=part.lower().replace(" ", "-"), band=band.lower())
        below = part.startswith("Transmission")
        assert opened.eval(WI, BELOW if below else ABOVE) == pytest.approx(value)
        assert opened.eval(WI, ABOVE if below else BELOW) == pytest.approx(0)


def test_a_part_that_is_missing_names_those_there_are(sheet):
    with pytest.raises(burnish.Error, match="expected part reflection-back, found reflection-front"):
        burnish.open_source(sheet, part="reflection-back")
    with pytest.raises(burnish.Error, match="expected band 'UV'"):
        burnish.open_source(sheet, band="UV")
    with pytest.raises(burnish.Error, match="part: expected one of reflection-front"):
        burnish.open_source(sheet, part="transmision-front")


def test_a_model_keeps_its_part(sheet, tmp_path):
    source = burnish.open_source(sheet, part="transmission-front", band="nir")
    model = burnish.fit(source, model="pqp", samples=2000)
    assert (model.notes["part"], model.notes["band"]) == ("transmission-front", "NIR")
    burnish.write_model(tmp_path / "through.burnish", model)
    again = burnish.open_source(tmp_path / "through.burnish")
    assert again.eval(WI, BELOW) == pytest.approx(0.05, rel=0.02)
    assert again.eval(WI, ABOVE) == pytest.approx(0)


def test_a_batch_opens_the_part(sheet, tmp_path, cli):
    how = {"model": "pqp", "samples": 2000}
    (row,) = burnish.batch([str(sheet)], tmp_path / "python", part="transmission-back", band="visible", **how)
    assert "reason" not in row
    made = tmp_path / "python" / row["files"][0]["path"]
    through = burnish.open_source(made)
    assert through.eval(WI, BELOW) == pytest.approx(0.03, rel=0.02)
    (tmp_path / "list").write_text(str(sheet))
    cli("batch", tmp_path / "list", "-o", tmp_path / "cli", "--part", "transmission-back", "--band", "visible",
        "--model", "pqp", "--samples", "2000")
    assert made.read_bytes() == (tmp_path / "cli" / row["files"][0]["path"]).read_bytes()
    (missing,) = burnish.batch([str(sheet)], tmp_path / "missing", part="reflection-back", **how)
    assert "expected part reflection-back" in missing["reason"]
    with pytest.raises(burnish.Error, match="part: expected one of"):
        burnish.batch([str(sheet)], tmp_path / "wrong", part="front")
    assert not (tmp_path / "wrong").exists()


def test_totals_scale_a_zemax_file(tmp_path):
    rows = "0.1 0.1\n" * 2
    file = tmp_path / "paint.bsdf"
    file.write_text(
        "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n"
        "AngleOfIncidence 1\n0\nScatterAzimuth 2\n0 180\nScatterRadial 2\n0 90\n\nMonochrome\nDataBegin\nTIS 0.6283\n"
        f"{rows}DataEnd\n"
    )
    assert burnish.open_source(file).eval(WI, ABOVE) == pytest.approx(0.1)
    assert burnish.open_source(file, scale_to_tis=True).eval(WI, ABOVE) == pytest.approx(0.2, rel=0.01)
