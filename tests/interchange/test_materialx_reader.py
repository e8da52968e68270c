"""MaterialX documents as records: values, graphs, pictures, and what the report says of each input."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from sssgen.interchange.imported_material import ImportedMaterial
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import Image, Quantity, SurfaceModel
from sssgen.interchange.texels import mean_of, texel_values
from sssgen.scene.pictures.images import write_png

pytest.importorskip("MaterialX")

from sssgen.interchange import materialx_reader

TEXELS = np.array([[[0.0, 0.25, 0.5, 1.0], [1.0, 0.75, 0.25, 0.0]], [[0.5, 0.5, 0.5, 0.5], [0.2, 0.4, 0.6, 0.8]]])
"""Height, width, rgba: what the picture colors.png stores."""


def read(
    folder: Path, content: str, attributes: str = "", version: str = "1.39"
) -> tuple[list[ImportedMaterial], Report]:
    """The materials of a document with this content, beside the picture colors.png."""
    write_png(folder / "colors.png", TEXELS)
    path = folder / "document.mtlx"
    path.write_text(f'<materialx version="{version}" {attributes}>{content}</materialx>', encoding="utf-8")
    report = Report("document.mtlx")
    return materialx_reader.read(str(path), report), report


def shader(inputs: str, graph: str = "", category: str = "standard_surface") -> str:
    """A material with a shader of these inputs, and the nodes of a graph."""
    return (
        f'{graph}<{category} name="S" type="surfaceshader">{inputs}</{category}><surfacematerial name="M" '
        'type="material"><input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial>'
    )


def model(folder: Path, content: str, attributes: str = "", version: str = "1.39") -> SurfaceModel:
    """The one material of a document."""
    materials, _ = read(folder, content, attributes, version)
    assert len(materials) == 1
    return materials[0].model


def color(folder: Path, nodes: str, attributes: str = "") -> Quantity:
    """The base colour that the node `out` of a graph gives."""
    graph = f'<nodegraph name="G">{nodes}<output name="o" type="color3" nodename="out"/></nodegraph>'
    inputs = '<input name="base" type="float" value="1"/>'
    inputs += '<input name="base_color" type="color3" nodegraph="G" output="o"/>'
    return model(folder, shader(inputs, graph), attributes).base_color


def number(folder: Path, nodes: str) -> Quantity:
    """The roughness that the node `out` of a graph gives."""
    graph = f'<nodegraph name="G">{nodes}<output name="o" type="float" nodename="out"/></nodegraph>'
    return model(
        folder, shader('<input name="specular_roughness" type="float" nodegraph="G" output="o"/>', graph)
    ).roughness


def value(name: str, kind: str, text: str) -> str:
    """An input with a constant."""
    return f'<input name="{name}" type="{kind}" value="{text}"/>'


def link(name: str, kind: str, node: str, output: str = "") -> str:
    """An input that is connected with a node."""
    port = f' output="{output}"' if output else ""
    return f'<input name="{name}" type="{kind}" nodename="{node}"{port}/>'


def node(category: str, name: str, kind: str, *inputs: str) -> str:
    """A node."""
    return f'<{category} name="{name}" type="{kind}">{"".join(inputs)}</{category}>'


def image(name: str, kind: str, *inputs: str, space: str = "") -> str:
    """An image node that reads colors.png."""
    space = f' colorspace="{space}"' if space else ""
    return node("image", name, kind, f'<input name="file" type="filename" value="colors.png"{space}/>', *inputs)


def roughness(source: str) -> str:
    """A material whose roughness is a node's."""
    return shader(link("specular_roughness", "float", source))


FILE = value("file", "filename", "colors.png")


def image_of(quantity: Quantity) -> Image:
    """The image of a quantity that has one."""
    assert quantity.image is not None
    return quantity.image


class TestShaders:
    def test_open_pbr(self, tmp_path: Path) -> None:
        inputs = [
            value("base_weight", "float", "0.5"),
            value("base_color", "color3", "0.8, 0.4, 0.2"),
            value("base_metalness", "float", "0.25"),
            value("specular_roughness", "float", "0.4"),
            value("specular_ior", "float", "1.33"),
            value("coat_weight", "float", "0.7"),
            value("coat_roughness", "float", "0.1"),
            value("emission_luminance", "float", "3"),
            value("emission_color", "color3", "1, 0.5, 0"),
        ]
        result = model(tmp_path, shader("".join(inputs), category="open_pbr_surface"))
        assert result.base_color.factor == pytest.approx((0.4, 0.2, 0.1))
        assert (result.metalness.factor, result.roughness.factor) == ((0.25,), (0.4,))
        assert (result.ior, result.coat.factor, result.coat_roughness.factor) == (1.33, (0.7,), (0.1,))
        assert result.emission.factor == (3.0, 1.5, 0.0)
        assert not result.transmits and result.interior is None

    def test_values_that_are_not_set_are_those_of_the_definition(self, tmp_path: Path) -> None:
        result = model(tmp_path, shader("", category="open_pbr_surface"))
        assert result.base_color.factor == pytest.approx((0.8, 0.8, 0.8))
        assert (result.roughness.factor, result.ior) == ((0.3,), 1.5)
        assert model(tmp_path, shader("")).base_color.factor == pytest.approx((0.8, 0.8, 0.8))

    def test_subsurface_of_open_pbr(self, tmp_path: Path) -> None:
        """The mean free path is radius times scale; the albedo is the one of a thick body with this colour."""
        inputs = [
            value("subsurface_weight", "float", "0.6"),
            value("subsurface_color", "color3", "0.8, 0.5, 0.2"),
            value("subsurface_radius", "float", "0.1"),
            value("subsurface_radius_scale", "color3", "1, 0.5, 0.25"),
            value("subsurface_scatter_anisotropy", "float", "0.3"),
        ]
        result = model(tmp_path, shader("".join(inputs), category="open_pbr_surface"))
        assert result.interior is not None
        assert result.interior.extinction == pytest.approx((10.0, 20.0, 40.0))
        assert result.interior.anisotropy == 0.3
        assert result.subsurface.factor == (0.6,)
        assert result.interior.albedo[0] > result.interior.albedo[1] > result.interior.albedo[2] > 0.2

    def test_transmission_is_beer_and_lambert(self, tmp_path: Path) -> None:
        inputs = [
            value("transmission_weight", "float", "1"),
            value("transmission_color", "color3", "0.5, 0.25, 0.125"),
            value("transmission_depth", "float", "2"),
            value("transmission_scatter", "color3", "0.1, 0.2, 0.3"),
        ]
        result = model(tmp_path, shader("".join(inputs), category="open_pbr_surface"))
        assert result.interior is not None and result.transmission_tint == Quantity((1.0, 1.0, 1.0))
        assert result.interior.extinction == pytest.approx([n * math.log(2.0) / 2.0 for n in (1, 2, 3)])
        assert result.interior.scattering == pytest.approx((0.05, 0.1, 0.15))
        assert result.thickness.is_zero, "the depth is no thickness: the mesh has that"

    def test_more_scattering_than_extinction_raises_the_absorption_of_all_channels(self, tmp_path: Path) -> None:
        inputs = [
            value("transmission", "float", "1"),
            value("transmission_color", "color3", "0.5, 0.25, 0.125"),
            value("transmission_depth", "float", "1"),
            value("transmission_scatter", "color3", "0.9, 0.9, 0.9"),
        ]
        result = model(tmp_path, shader("".join(inputs)))
        assert result.interior is not None
        least = 0.9 - math.log(2.0)
        assert result.interior.absorption == pytest.approx([n * math.log(2.0) - 0.9 + least for n in (1, 2, 3)])

    def test_transmission_without_depth_is_a_tint(self, tmp_path: Path) -> None:
        inputs = value("transmission", "float", "1") + value("transmission_color", "color3", "0.5, 0.25, 0.125")
        result = model(tmp_path, shader(inputs))
        assert result.transmission_tint == Quantity((0.5, 0.25, 0.125)) and result.interior is None

    def test_a_sheet_of_open_pbr(self, tmp_path: Path) -> None:
        """What it reflects and transmits is half of the colour, moved by the anisotropy."""
        inputs = [
            value("geometry_thin_walled", "boolean", "true"),
            value("base_color", "color3", "0.6, 0.6, 0.6"),
            value("subsurface_weight", "float", "0.5"),
            value("subsurface_color", "color3", "0.8, 0.4, 0.2"),
            value("subsurface_scatter_anisotropy", "float", "0.5"),
        ]
        result = model(tmp_path, shader("".join(inputs), category="open_pbr_surface"))
        share = result.diffuse_transmission.factor[0]
        transmitted = [share * part for part in result.diffuse_transmission_color.factor]
        reflected = [(1.0 - share) * part for part in result.base_color.factor]
        assert transmitted == pytest.approx([0.5 * 0.5 * 1.5 * part for part in (0.8, 0.4, 0.2)])
        assert reflected == pytest.approx([0.3 + 0.5 * 0.5 * 0.5 * part for part in (0.8, 0.4, 0.2)])
        assert result.thin_walled and result.two_sided and result.interior is None

    def test_gltf(self, tmp_path: Path) -> None:
        inputs = [
            value("base_color", "color3", "0.5, 0.5, 0.5"),
            value("alpha", "float", "0.5"),
            value("alpha_mode", "integer", "2"),
            value("transmission", "float", "1"),
            value("thickness", "float", "0.2"),
            value("attenuation_distance", "float", "0.5"),
            value("attenuation_color", "color3", "0.5, 1, 1"),
        ]
        result = model(tmp_path, shader("".join(inputs), category="gltf_pbr"))
        assert (result.alpha_mode, result.opacity.factor, result.thickness.factor) == ("blend", (0.5,), (0.2,))
        assert result.interior is not None
        assert result.interior.absorption == pytest.approx((math.log(2.0) / 0.5, 0.0, 0.0))

    def test_a_colour_above_1_that_light_fades_to_is_limited_and_reported(self, tmp_path: Path) -> None:
        inputs = [
            value("transmission", "float", "1"), value("thickness", "float", "0.2"),
            value("attenuation_distance", "float", "0.5"), value("attenuation_color", "color3", "1.4, 0.5, 1"),
        ]  # fmt: skip
        (imported,), report = read(tmp_path, shader("".join(inputs), category="gltf_pbr"))
        assert imported.model.interior is not None
        assert imported.model.interior.absorption == pytest.approx((0.0, math.log(2.0) / 0.5, 0.0))
        (row,) = [row for row in report.rows if row.element.endswith("attenuation_color")]
        assert (row.outcome, row.became) == ("approximated", "limited to 0 to 1: 1, 0.5, 1")

    def test_usd_preview_surface(self, tmp_path: Path) -> None:
        inputs = value("diffuseColor", "color3", "0.1, 0.2, 0.3") + value("opacity", "float", "0.25")
        result = model(tmp_path, shader(inputs, category="UsdPreviewSurface"))
        assert (result.base_color.factor, result.alpha_mode) == ((0.1, 0.2, 0.3), "opaque")
        assert (result.transmission.factor, result.thin_walled) == ((0.75,), True)  # it still reflects, unlike a blend

    def test_a_document_without_materials_has_its_shaders(self, tmp_path: Path) -> None:
        assert model(tmp_path, '<standard_surface name="alone" type="surfaceshader"/>').name == "alone"

    def test_units_and_old_versions(self, tmp_path: Path) -> None:
        inputs = [
            value("subsurface", "float", "1"),
            value("subsurface_radius", "color3", "1, 1, 1"),
            '<input name="subsurface_scale" type="float" value="5" unit="millimeter" unittype="distance"/>',
        ]
        result = model(tmp_path, shader("".join(inputs)), version="1.38")
        assert result.interior is not None
        assert result.interior.extinction == pytest.approx((200.0, 200.0, 200.0))


class TestGraphs:
    def test_constants(self, tmp_path: Path) -> None:
        operands = value("in1", "color3", "0.09, 0.25, 0.49") + value("in2", "float", "0.5")
        for node, expected in (
            ("add", (0.59, 0.75, 0.99)),
            ("multiply", (0.045, 0.125, 0.245)),
            ("power", (0.3, 0.5, 0.7)),
        ):
            result = color(tmp_path, f'<{node} name="out" type="color3">{operands}</{node}>')
            assert result.factor == pytest.approx(expected, abs=1e-4), node

    def test_a_picture_keeps_its_file(self, tmp_path: Path) -> None:
        """Colours are decoded, numbers are not; a factor stays a factor."""
        product = node("multiply", "out", "color3", link("in1", "color3", "a"), value("in2", "color3", "0.5, 1, 1"))
        result = color(tmp_path, image("a", "color3", space="srgb_texture") + product)
        assert result.factor == (0.5, 1.0, 1.0)
        assert (image_of(result).channels, image_of(result).srgb) == ("rgb", True)
        assert image_of(result).picture.content == (tmp_path / "colors.png").read_bytes()
        numbers = number(tmp_path, image("out", "float"))
        assert (image_of(numbers).channels, image_of(numbers).srgb) == ("r", False)

    def test_channels(self, tmp_path: Path) -> None:
        nodes = [
            image("a", "color4"),
            node("separate4", "s", "multioutput", link("in", "color4", "a")),
            node("dot", "out", "float", link("in", "float", "s", "outa")),
        ]
        assert image_of(number(tmp_path, "".join(nodes))).channels == "a"
        extract = node("extract", "out", "float", link("in", "vector3", "a"), value("index", "integer", "2"))
        assert image_of(number(tmp_path, image("a", "vector3") + extract)).channels == "b"

    def test_computed_texels(self, tmp_path: Path) -> None:
        """One minus a picture, a mix of two colours by a picture: written as pictures of their own."""
        result = number(tmp_path, image("a", "float") + node("invert", "out", "float", link("in", "float", "a")))
        assert result.factor[0] * texel_values(image_of(result))[..., 0] == pytest.approx(
            1.0 - TEXELS[..., 0], abs=3e-3
        )
        ends = value("bg", "color3", "0, 0, 0.5") + value("fg", "color3", "1, 0, 1")
        mix = node("mix", "out", "color3", ends, link("mix", "float", "a"))
        share = TEXELS[..., :1]
        expected = (1.0 - share) * np.array([0.0, 0.0, 0.5]) + share * np.array([1.0, 0.0, 1.0])
        mixed = texel_values(image_of(color(tmp_path, image("a", "float") + mix)))
        assert mixed == pytest.approx(expected, abs=6e-3)

    def test_numbers_above_one_stay(self, tmp_path: Path) -> None:
        total = node("add", "out", "float", link("in1", "float", "a"), value("in2", "float", "2"))
        nodes = image("a", "float") + total
        emission = model(tmp_path, nodes + shader(link("emission", "float", "out"))).emission
        assert mean_of(emission)[0] == pytest.approx(2.0 + TEXELS[..., 0].mean(), abs=0.02)
        assert max(number(tmp_path, nodes).factor) == 1.0, "a roughness is at most 1"

    @pytest.mark.parametrize(
        ("inputs", "tiling", "offset", "rotation"),
        [
            ({"scale": "0.5, 0.25", "offset": "0.1, 0.2"}, (2.0, 4.0), (-0.1, -0.2), 0.0),
            ({"pivot": "0.5, 0.5", "scale": "0.5, 0.5"}, (2.0, 2.0), (-0.5, -0.5), 0.0),
        ],
    )
    def test_place2d(
        self, tmp_path: Path, inputs: dict[str, str], tiling: tuple[float, ...], offset: object, rotation: float
    ) -> None:
        """It moves by the pivot, divides by the scale, turns clockwise, and moves back."""
        values = "".join(value(name, "vector2", text) for name, text in inputs.items())
        place = node("place2d", "p", "vector2", link("texcoord", "vector2", "t"), values)
        nodes = node("texcoord", "t", "vector2") + place + image("out", "color3", link("texcoord", "vector2", "p"))
        transform = image_of(color(tmp_path, nodes)).transform
        assert (transform.tiling, transform.offset) == (pytest.approx(tiling), pytest.approx(offset))
        assert transform.rotation == pytest.approx(rotation)

    def test_turned_and_tiled_pictures(self, tmp_path: Path) -> None:
        place = node("texcoord", "t", "vector2")
        place += node("rotate2d", "r", "vector2", link("in", "vector2", "t"), value("amount", "float", "90"))
        transform = image_of(
            color(tmp_path, place + image("out", "color3", link("texcoord", "vector2", "r")))
        ).transform
        assert transform.rotation == pytest.approx(-90.0)
        tiled = node("tiledimage", "out", "color3", FILE, value("uvtiling", "vector2", "3, 2"))
        assert image_of(color(tmp_path, tiled)).transform.tiling == pytest.approx((3.0, 2.0))

    def test_nodes_of_gltf(self, tmp_path: Path) -> None:
        """The library's own graphs are followed: gltf_colorimage has a factor, and alpha as its second output."""
        factor = value("color", "color4", "0.5, 0.5, 0.5, 1")
        nodes = node("gltf_colorimage", "c", "multioutput", FILE, factor)
        result = color(tmp_path, nodes + node("dot", "out", "color3", link("in", "color3", "c", "outcolor")))
        assert (result.factor, image_of(result).channels) == ((0.5, 0.5, 0.5), "rgb")
        assert (
            image_of(number(tmp_path, nodes + node("dot", "out", "float", link("in", "float", "c", "outa")))).channels
            == "a"
        )

    def test_a_normal_map(self, tmp_path: Path) -> None:
        normal = node("normalmap", "n", "vector3", link("in", "vector3", "i"), value("scale", "float", "0.5"))
        result = model(tmp_path, shader(link("normal", "vector3", "n"), image("i", "vector3") + normal)).normal
        assert (result.factor, image_of(result).channels) == ((0.5,), "rgb")

    def test_color_spaces(self, tmp_path: Path) -> None:
        """Constants are converted by MaterialX's own graphs; the space is that of the nearest element around."""
        content = shader(value("base", "float", "1") + value("base_color", "color3", "0.5, 0.5, 0.5"))
        for space, expected in (("srgb_texture", 0.2140), ("lin_rec709", 0.5), ("g22_rec709", 0.5**2.2)):
            factor = model(tmp_path, content, f'colorspace="{space}"').base_color.factor
            assert factor == pytest.approx((expected,) * 3, abs=1e-4), space
        wide = '<input name="base_color" type="color3" value="0.5, 0, 0" colorspace="acescg"/>'
        assert model(tmp_path, shader(wide)).base_color.factor[0] == pytest.approx(0.8525, abs=1e-3)

    def test_interfaces(self, tmp_path: Path) -> None:
        graph = f"""<nodegraph name="G">{value("tint", "color3", "0.1, 0.2, 0.3")}
            <dot name="d" type="color3"><input name="in" type="color3" interfacename="tint"/></dot>
            <output name="o" type="color3" nodename="d"/></nodegraph>"""
        inputs = value("base", "float", "1") + '<input name="base_color" type="color3" nodegraph="G"/>'
        assert model(tmp_path, shader(inputs, graph)).base_color.factor == (0.1, 0.2, 0.3)

    def test_a_definition_of_the_document(self, tmp_path: Path) -> None:
        """A node that the document itself defines by a graph."""
        graph = f"""<nodedef name="ND_mine" node="mine">{value("a", "color3", "0, 0, 0")}
            <output name="out" type="color3"/></nodedef><nodegraph name="NG_mine" nodedef="ND_mine">
            <invert name="i" type="color3"><input name="in" type="color3" interfacename="a"/></invert>
            <output name="out" type="color3" nodename="i"/></nodegraph>"""
        graph += node("mine", "use", "color3", value("a", "color3", "0.25, 0.5, 1"))
        inputs = value("base", "float", "1") + link("base_color", "color3", "use")
        assert model(tmp_path, shader(inputs, graph)).base_color.factor == pytest.approx((0.75, 0.5, 0.0))

    def test_file_prefix(self, tmp_path: Path) -> None:
        (tmp_path / "maps").mkdir()
        write_png(tmp_path / "maps" / "grey.png", np.full((2, 2, 3), 0.5))
        picture = node("image", "i", "float", value("file", "filename", "grey.png"))
        graph = (
            f'<nodegraph name="G" fileprefix="maps/">{picture}<output name="o" type="float" nodename="i"/></nodegraph>'
        )
        result = model(tmp_path, shader('<input name="specular_roughness" type="float" nodegraph="G"/>', graph))
        assert image_of(result.roughness).picture.name == "grey.png"

    def test_includes(self, tmp_path: Path) -> None:
        (tmp_path / "inner.mtlx").write_text(f'<materialx version="1.39">{shader("")}</materialx>', encoding="utf-8")
        content = '<xi:include href="inner.mtlx"/>'
        assert model(tmp_path, content, 'xmlns:xi="http://www.w3.org/2001/XInclude"').name == "M"


class TestReport:
    def test_each_input_has_one_row(self, tmp_path: Path) -> None:
        """Rows of the report and elements of the fields together name every input that the document sets, once."""
        inputs = [
            value("base_color", "color3", "0.5, 0.5, 0.5"),
            value("subsurface_weight", "float", "0.5"),
            value("subsurface_color", "color3", "0.5, 0.5, 0.5"),
            value("fuzz_weight", "float", "0.5"),
            value("fuzz_color", "color3", "1, 1, 1"),
            value("thin_film_thickness", "float", "0.5"),
            value("transmission_weight", "float", "0"),
            value("coat_darkening", "float", "1"),
        ]
        materials, report = read(tmp_path, shader("".join(inputs), category="open_pbr_surface"))
        paths = [row.element for row in report.rows]
        paths += [element.path for elements in materials[0].elements.values() for element in elements]
        assert sorted(paths) == sorted(f"/S/{text.split(chr(34))[1]}" for text in inputs)
        outcomes = {row.element: row.outcome for row in report.rows}
        assert outcomes["/S/fuzz_color"] == "left out"
        assert outcomes["/S/thin_film_thickness"] == "mapped", "its weight is 0"

    def test_a_procedural_graph_is_left_out_with_the_node_and_its_mean(self, tmp_path: Path) -> None:
        noise = node("noise3d", "grain", "float", value("pivot", "float", "0.25"))
        materials, report = read(tmp_path, noise + roughness("grain"))
        assert materials[0].model.roughness.factor == (0.25,)
        row = next(row for row in report.rows if row.element == "/S/specular_roughness")
        assert row.outcome == "left out" and "grain" in row.became and "0.25" in row.became

    def test_pictures_with_other_coordinates_are_combined_as_means(self, tmp_path: Path) -> None:
        nodes = [
            image("a", "float"),
            node("tiledimage", "b", "float", FILE, value("uvtiling", "vector2", "2, 2")),
            node("add", "sum", "float", link("in1", "float", "a"), link("in2", "float", "b")),
        ]
        materials, report = read(tmp_path, "".join(nodes) + roughness("sum"))
        assert materials[0].model.roughness.factor == pytest.approx((2.0 * TEXELS[..., 0].mean(),), abs=0.01)
        assert [row.outcome for row in report.rows if row.element == "/S/specular_roughness"] == ["left out"]
