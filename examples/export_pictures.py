#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One sphere in every program that exports are written for, beside our own renderer's.

    examples/export_pictures.py build/release/apps/burnish/burnish paint.exr --measurement paint.bsdf \
      --openpbr paint.json --npm FOLDER --blender PYTHON -o export.png

Exports the factored model paint.exr and the OpenPBR parameters, shows each export in the program it is for, under the
same camera and the same point light, prints how far each picture is from our renderer's of the same model, and writes
all of them as one sheet. Needs numpy, materialx, moderngl, mitsuba and the package burnish; three and babylonjs of npm
in FOLDER/node_modules, and Chromium; and a Python with bpy (Blender), by default this one. A program that is missing
is named and left out.

OpenPBR is a node of MaterialX and has the KHR extensions of glTF. three.js and Mitsuba have no such material and get
its formulas; so does Babylon.js, whose own material of that name is drawn last.
"""
import argparse
import base64
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import numpy as np

# The scene: that of `burnish render --mesh sphere --lights 2,3,4:20`.
FIELD_OF_VIEW = 0.6
EYE = (0.0, 0.0, 1.04 / math.sin(FIELD_OF_VIEW / 2))
LIGHT = (2.0, 3.0, 4.0)
INTENSITY = 20.0
SAMPLES = 4  # a pixel along each axis

CHROMIUM = ["timeout", "300", "chromium", "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--allow-file-access-from-files", "--virtual-time-budget=60000", "--dump-dom"]


def sphere(columns=256, rows=128):
    """Positions, which are normals too, tangents around y, triangles."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, columns + 1), np.linspace(0, np.pi, rows + 1))
    position = np.stack([np.sin(v) * np.sin(u), -np.cos(v), np.sin(v) * np.cos(u)], -1).reshape(-1, 3)
    tangent = np.stack([np.cos(u), 0 * u, -np.sin(u), 1 + 0 * u], -1).reshape(-1, 4)
    at = np.arange((columns + 1) * rows).reshape(rows, columns + 1)[:, :-1].ravel()
    up = at + columns + 1
    triangles = np.stack([at, at + 1, up + 1, at, up + 1, up], -1)
    return position.astype("f4"), tangent.astype("f4"), triangles.astype("u4")


def averaged(picture):
    """Squares of SAMPLES pixels as one."""
    height, width, channels = picture.shape
    return picture.reshape(height // SAMPLES, SAMPLES, width // SAMPLES, SAMPLES, channels).mean((1, 3))


def read_exr(path):
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    bitmap = mi.Bitmap(str(path))
    return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False))


def in_burnish(cli, material, size, folder, renderer="cpu"):
    picture = folder / "burnish.exr"
    subprocess.run([cli, "render", "--mesh", "sphere", "--material", material, "--renderer", renderer, "--size",
                    str(size), "--samples", str(SAMPLES), "--lights", ",".join(map(str, LIGHT)) + f":{INTENSITY}",
                    "-o", picture], check=True, stdout=subprocess.DEVNULL)
    return read_exr(picture)


def exported(cli, model, folder, *targets):
    arguments = [argument for target in targets for argument in ("--to", target)]
    subprocess.run([cli, "export", model, *arguments, "--name", "m", "-o", folder], check=True,
                   stdout=subprocess.DEVNULL)
    return folder


# MaterialX's point light falls with the square of the distance + 1; the scene's with that of the distance.
THEIR_FALL, OUR_FALL = "pow(distance + 1.0, light.decay_rate + M_FLOAT_EPS)", "(distance * distance)"


def generated_glsl(path):
    """Vertex and pixel shader that MaterialX makes of the first material of a document, with one point light."""
    import MaterialX as mx
    from MaterialX import PyMaterialXGenGlsl as gen_glsl
    from MaterialX import PyMaterialXGenShader as gen

    library, document = mx.createDocument(), mx.createDocument()
    search = mx.getDefaultDataSearchPath()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), search, library)
    document.setDataLibrary(library)
    search.append(mx.FilePath(str(path.parent)))
    mx.readFromXmlFile(document, str(path))
    valid, why = document.validate()
    if not valid:
        raise ValueError(f"{path}: {why}")
    generator = gen_glsl.GlslShaderGenerator.create()
    context = gen.GenContext(generator)
    context.registerSourceCodeSearchPath(search)
    context.getOptions().hwMaxActiveLightSources = 1
    context.getOptions().hwSpecularEnvironmentMethod = gen.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_NONE
    generator.registerTypeDefs(document)
    gen.HwShaderGenerator.bindLightShader(library.getNodeDef("ND_point_light"), 1, context)
    surface = mx.getShaderNodes(document.getMaterialNodes()[0])[0]
    shader = generator.generate("m", surface, context)
    textures = {}
    for node in document.getNodes():
        for given in node.getInputs():
            if given.getType() == "filename":
                textures[f"{node.getName()}_{given.getName()}"] = path.parent / given.getValueString()
    pixel = shader.getSourceCode("pixel")
    if THEIR_FALL not in pixel:
        raise RuntimeError("the point light is not the one that is known")
    pixel = pixel.replace(THEIR_FALL, OUR_FALL)
    if "bool u_refractionTwoSided" not in pixel:  # 1.39.5 uses it of opaque materials too, without declaring it
        version, rest = pixel.split("\n", 1)
        pixel = f"{version}\nconst bool u_refractionTwoSided = false;\n{rest}"
    return shader.getSourceCode("vertex"), pixel, textures


def projection():
    f, near, far = 1 / math.tan(FIELD_OF_VIEW / 2), 0.5, 10.0
    matrix = np.array([[f, 0, 0, 0], [0, f, 0, 0],
                       [0, 0, (far + near) / (near - far), 2 * far * near / (near - far)], [0, 0, -1, 0]])
    matrix[:, 3] -= matrix[:, 2] * EYE[2]  # the camera looks along -z
    return matrix


def in_materialx(document, size, _):
    """By the GLSL that MaterialX generates, run on OpenGL."""
    import moderngl

    vertex, pixel, textures = generated_glsl(document)
    gl = moderngl.create_standalone_context(backend="egl")
    program = gl.program(vertex_shader=vertex, fragment_shader=pixel)

    def put(name, value):
        if name in program:
            program[name].value = value

    identity = tuple(np.eye(4).ravel())
    for name in ("u_worldMatrix", "u_worldInverseTransposeMatrix"):
        put(name, identity)
    put("u_viewProjectionMatrix", tuple(projection().T.ravel()))
    put("u_viewPosition", EYE)
    put("u_numActiveLightSources", 1)
    for name, value in {"type": 1, "position": LIGHT, "color": (1.0, 1.0, 1.0), "intensity": INTENSITY}.items():
        put(f"u_lightData[0].{name}", value)
    for unit, (name, file) in enumerate(textures.items()):
        image = read_exr(file)
        texture = gl.texture(image.shape[1::-1], 3, image.tobytes(), dtype="f4")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.use(unit)
        program[name].value = unit
    position, tangent, triangles = sphere()
    sources = {"i_position": position, "i_normal": position, "i_tangent": np.ascontiguousarray(tangent[:, :3])}
    attributes = [(gl.buffer(values), "3f", name) for name, values in sources.items() if name in program]
    side = size * SAMPLES
    frame = gl.framebuffer([gl.texture((side, side), 4, dtype="f4")], gl.depth_renderbuffer((side, side)))
    frame.use()
    frame.clear(0, 0, 0, 0)
    gl.enable(moderngl.DEPTH_TEST)
    gl.vertex_array(program, attributes, gl.buffer(triangles)).render()
    picture = np.frombuffer(frame.read(components=4, dtype="f4"), "f4").reshape(side, side, 4)[::-1, :, :3]
    gl.release()
    return averaged(picture)


# Draws m.three.js or m.babylon.js into floats; %(...)s are numbers and addresses.
THREE = """import * as THREE from "%(three)s";
import {createMaterial} from "./m.three.js";
const renderer = new THREE.WebGLRenderer(), target = new THREE.WebGLRenderTarget(side, side, {type: THREE.FloatType});
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(fov * 180 / Math.PI, 1, 0.5, 10);
camera.position.set(...eye);
const light = new THREE.PointLight(0xffffff, intensity);
light.position.set(...lamp);
const shape = new THREE.BufferGeometry();
shape.setAttribute("position", new THREE.BufferAttribute(position, 3));
shape.setAttribute("normal", new THREE.BufferAttribute(position, 3));
shape.setAttribute("tangent", new THREE.BufferAttribute(tangent, 4));
shape.setIndex(new THREE.BufferAttribute(triangles, 1));
scene.add(light, new THREE.Mesh(shape, createMaterial(THREE)));
renderer.setRenderTarget(target);
renderer.render(scene, camera);
const pixels = new Float32Array(4 * side * side);
renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
done(pixels);
"""
BABYLON = """import {createMaterial} from "./m.babylon.js";
const canvas = document.createElement("canvas");
canvas.width = canvas.height = 64;
const engine = new BABYLON.Engine(canvas, false);
const scene = new BABYLON.Scene(engine);
scene.useRightHandedSystem = true;
scene.clearColor = new BABYLON.Color4(0, 0, 0, 0);
const camera = new BABYLON.FreeCamera("c", new BABYLON.Vector3(...eye), scene);
camera.setTarget(BABYLON.Vector3.Zero());
Object.assign(camera, {fov, minZ: 0.5, maxZ: 10});
const light = new BABYLON.PointLight("l", new BABYLON.Vector3(...lamp), scene);
light.intensity = intensity;
const mesh = new BABYLON.Mesh("s", scene), data = new BABYLON.VertexData();
Object.assign(data, {positions: position, normals: position, tangents: tangent, indices: triangles});
data.applyToMesh(mesh);
mesh.material = createMaterial(BABYLON, scene, {linear: true});
mesh.material.backFaceCulling = false;
const target = new BABYLON.RenderTargetTexture("t", side, scene, false, true, BABYLON.Constants.TEXTURETYPE_FLOAT);
target.clearColor = scene.clearColor;
target.activeCamera = camera;
target.renderList = [mesh];
scene.whenReadyAsync().then(async () => {
  while (!mesh.material.isReady(mesh)) await new Promise((next) => setTimeout(next, 50));
  target.render();
  done(await target.readPixels());
});
"""


def babylon_openpbr(mtlx):
    """BABYLON with the program's own OpenPBRMaterial, its inputs those of a .mtlx's open_pbr_surface."""
    node = xml.etree.ElementTree.parse(mtlx).getroot().find(".//open_pbr_surface")
    camel = lambda name: name.split("_")[0] + "".join(word.capitalize() for word in name.split("_")[1:])
    lines = ['mesh.material = new BABYLON.OpenPBRMaterial("m", scene);',
             "scene.imageProcessingConfiguration.applyByPostProcess = true;  // linear"]
    for given in node.findall("input"):
        value = given.get("value")
        if given.get("type") == "color3":
            value = f"new BABYLON.Color3({value})"
        if given.get("type") in ("color3", "float"):
            lines.append(f'mesh.material.{camel(given.get("name"))} = {value};')
    loaded, made = 'import {createMaterial} from "./m.babylon.js";\n', "mesh.material = createMaterial(BABYLON, scene, {linear: true});"
    assert loaded in BABYLON and made in BABYLON
    return BABYLON.replace(loaded, "").replace(made, "\n".join(lines))


def in_chromium(script, folder, size, **addresses):
    side = size * SAMPLES
    position, tangent, triangles = sphere()
    arrays = {"position": ("Float32Array", position), "tangent": ("Float32Array", tangent),
              "triangles": ("Uint32Array", triangles)}
    decoded = "\n".join(
        f'const {name} = new {kind}(Uint8Array.from(atob("{base64.b64encode(values.tobytes()).decode()}"), '
        "(c) => c.charCodeAt(0)).buffer);" for name, (kind, values) in arrays.items())
    page = folder / "page.html"
    library = f'<script src="{addresses["babylon"]}"></script>' if "babylon" in addresses else ""
    page.write_text(f"""<!DOCTYPE html><body>{library}<script type="module">
{(script % addresses) if "three" in addresses else script}
</script><script>
const side = {side}, eye = {list(EYE)}, lamp = {list(LIGHT)}, intensity = {INTENSITY}, fov = {FIELD_OF_VIEW};
{decoded}
function done(pixels) {{  // squares of SAMPLES pixels as one, from the bottom row
  const n = {SAMPLES}, small = new Float32Array(3 * (side / n) ** 2);
  for (let y = 0; y < side; ++y)
    for (let x = 0; x < side; ++x)
      for (let c = 0; c < 3; ++c)
        small[3 * (Math.floor(y / n) * side / n + Math.floor(x / n)) + c] += pixels[4 * (y * side + x) + c] / n ** 2;
  let text = "";
  for (const byte of new Uint8Array(small.buffer)) text += String.fromCharCode(byte);
  document.body.dataset.result = btoa(text);
}}
</script></body>""")
    with tempfile.TemporaryDirectory() as profile:
        dom = subprocess.run([*CHROMIUM, f"--user-data-dir={profile}", page.as_uri()], capture_output=True,
                             text=True).stdout
    mark = 'data-result="'
    if mark not in dom:
        raise RuntimeError(f"{page} drew nothing")
    text = dom[dom.index(mark) + len(mark):]
    return np.frombuffer(base64.b64decode(text[:text.index('"')]), "f4").reshape(size, size, 3)[::-1]


def in_mitsuba(bsdf, size, _):
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    import burnish.mitsuba

    burnish.mitsuba.register()
    place = mi.ScalarTransform4f()
    # its sphere has its tangents around z
    scene = mi.load_dict({
        "type": "scene", "integrator": {"type": "direct", "hide_emitters": True},
        "sensor": {"type": "perspective", "fov": math.degrees(FIELD_OF_VIEW),
                   "to_world": place.look_at(list(EYE), [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
                   "sampler": {"type": "stratified", "sample_count": 64}},
        "light": {"type": "point", "position": list(LIGHT), "intensity": {"type": "rgb", "value": INTENSITY}},
        "sphere": {"type": "sphere", "to_world": place.rotate([1, 0, 0], -90), "bsdf": bsdf}})
    return np.array(mi.render(scene))[..., :3]


# Run by a Python that has bpy: imports a file and renders it by Cycles.
BLENDER = """
import bpy, math, sys
file, out, size, eye, lamp, intensity, fov = *sys.argv[1:3], int(sys.argv[3]), *map(eval, sys.argv[4:8])
bpy.ops.wm.read_factory_settings(use_empty=True)
if file.endswith(".glb"): bpy.ops.import_scene.gltf(filepath=file)
else: bpy.ops.wm.usd_import(filepath=file, import_all_materials=True)
material = bpy.data.materials[0]
for shape in list(bpy.data.objects): bpy.data.objects.remove(shape)
bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128)
bpy.context.object.data.shade_smooth()
bpy.context.object.data.materials.append(material)
scene = bpy.context.scene
turned = lambda p: (p[0], -p[2], p[1])  # z is up
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.angle = fov
camera.location, camera.rotation_euler = turned(eye), (math.pi / 2, 0, 0)
light = bpy.data.objects.new("light", bpy.data.lights.new("light", "POINT"))
light.data.energy, light.data.shadow_soft_size = intensity * 4 * math.pi, 0
light.location = turned(lamp)
for thing in (camera, light): scene.collection.objects.link(thing)
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 64, False, 0
scene.cycles.pixel_filter_type = "BOX"
scene.render.resolution_x = scene.render.resolution_y = size
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
scene.view_settings.view_transform = "Raw"
scene.render.filepath = out
bpy.ops.render.render(write_still=True)
"""


def in_blender(python, file, size, folder):
    out = folder / f"{file.suffix[1:]}.blender.exr"
    done = subprocess.run([python, "-c", BLENDER, file, out, str(size), *map(str, (EYE, LIGHT, INTENSITY, FIELD_OF_VIEW))],
                          capture_output=True, text=True)
    if not out.exists():
        raise RuntimeError((done.stderr or done.stdout).strip().splitlines()[-1])
    return read_exr(out)


def exposure_of(truth):
    """97 % of what is lit are below 1."""
    lit = truth[truth.max(-1) > 0]
    return 1 / np.percentile(lit, 97)


def psnr(a, b):
    error = np.mean((np.clip(a, 0, 1) - np.clip(b, 0, 1)) ** 2)
    return -10 * math.log10(max(error, 1e-12))


def encoded(picture):
    x = np.clip(picture, 0, 1)
    return (255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055) + 0.5).astype("u1")


def jobs_of(cli, model, openpbr, arguments, folder):
    """Rows of names and (heading, what draws, whether the program has all of the model)."""
    npm = pathlib.Path(arguments.npm or folder).resolve() / "node_modules"
    three, babylon = npm / "three/build/three.module.js", npm / "babylonjs/babylon.js"
    size = arguments.size

    def web(at):
        def draw_three():
            if not three.exists():
                raise RuntimeError("no three in --npm")
            return in_chromium(THREE, at, size, three=three.as_uri())

        def draw_babylon():
            if not babylon.exists():
                raise RuntimeError("no babylonjs in --npm")
            return in_chromium(BABYLON, at, size, babylon=babylon.as_uri())

        return [("three.js", draw_three, True), ("Babylon.js", draw_babylon, True)]

    def babylon_own(at):
        if not babylon.exists():
            raise RuntimeError("no babylonjs in --npm")
        return in_chromium(babylon_openpbr(at / "m.mtlx"), at, size, babylon=babylon.as_uri())

    def blender(at):
        return [("Blender, glTF", lambda: in_blender(arguments.blender, at / "m.glb", size, at), False),
                ("Blender, USD", lambda: in_blender(arguments.blender, at / "m.usda", size, at), False)]

    a = exported(cli, model, folder / "factored", "materialx", "three", "babylon", "gltf", "usda")
    rows = [("factored", model, [("MaterialX GLSL", lambda: in_materialx(a / "m.mtlx", size, a), True), *web(a),
                                 ("Mitsuba", lambda: in_mitsuba({"type": "burnish", "filename": model}, size, a), True),
                                 *blender(a)])]
    if openpbr:
        b = exported(cli, openpbr, folder / "openpbr", "materialx", "three", "babylon", "gltf", "usda")
        rows.append(("OpenPBR", openpbr,
                     [("MaterialX GLSL", lambda: in_materialx(b / "m.mtlx", size, b), True), *web(b),
                      ("Mitsuba", lambda: in_mitsuba({"type": "burnish", "filename": openpbr}, size, b), True),
                      *blender(b), ("Babylon's own", lambda: babylon_own(b), False)]))
    return rows


def sheet(rows, labels):
    """Pictures in rows, with their headings, as an RGB array."""
    from PIL import Image, ImageDraw

    size, bar, gap = rows[0][0].shape[0], 30, 4
    width = max(len(row) for row in rows) * (size + gap) - gap
    image = Image.new("RGB", (width, len(rows) * (size + bar)), (24, 24, 24))
    draw = ImageDraw.Draw(image)
    for r, (row, names) in enumerate(zip(rows, labels)):
        for c, (picture, name) in enumerate(zip(row, names)):
            at = (c * (size + gap), r * (size + bar))
            draw.multiline_text((at[0] + 4, at[1] + 2), name, (220, 220, 220), spacing=1)
            image.paste(Image.fromarray(picture), (at[0], at[1] + bar))
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("burnish", help="the command line")
    parser.add_argument("model", help="a factored BRDF of three channels, as `burnish fit` writes it")
    parser.add_argument("--measurement", help="what it was fitted to")
    parser.add_argument("--openpbr", help="OpenPBR: openpbr:NAME=VALUE,... or what `burnish fit --to openpbr` writes")
    parser.add_argument("--npm", help="folder with node_modules that have three and babylonjs")
    parser.add_argument("--blender", default=sys.executable, help="a Python with bpy")
    parser.add_argument("--size", type=int, default=160)
    parser.add_argument("-o", "--output", help="the sheet, PNG")
    arguments = parser.parse_args()
    cli, model = os.path.abspath(arguments.burnish), os.path.abspath(arguments.model)

    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        pictures, labels = [], []
        first = arguments.measurement or model
        exposure = exposure_of(in_burnish(cli, first, arguments.size, folder))
        for name, reference, jobs in jobs_of(cli, model, arguments.openpbr, arguments, folder):
            truth = in_burnish(cli, reference, arguments.size, folder)
            row, names = [], []
            if arguments.measurement:
                row.append(encoded(exposure * in_burnish(cli, arguments.measurement, arguments.size, folder)))
                names.append("measurement")
            row.append(encoded(exposure * truth))
            names.append(f"{name}: burnish")
            if arguments.measurement:
                distance = psnr(exposure * truth, exposure * in_burnish(cli, arguments.measurement, arguments.size, folder))
                print(f"{name:9} {'to the measurement':16} {distance:6.2f} dB")
                names[-1] += f"\n{distance:.1f} dB"
            for program, draw, whole in jobs:
                try:
                    picture = draw()
                except (ImportError, RuntimeError, OSError) as error:
                    print(f"{name:9} {program:16} left out: {error}")
                    continue
                distance = psnr(exposure * picture, exposure * truth)
                print(f"{name:9} {program:16} {distance:6.2f} dB{'' if whole else '  (nearest material)'}", flush=True)
                row.append(encoded(exposure * picture))
                names.append(f"{program}\n{distance:.1f} dB")
            pictures.append(row)
            labels.append(names)
        if arguments.output:
            sheet(pictures, labels).save(arguments.output, optimize=True)


if __name__ == "__main__":
    main()
