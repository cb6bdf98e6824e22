
// A node material for WebGPURenderer, by WebGPU or WebGL. THREE: the module three/webgpu. Directional, point and spot
// lights are reflected by the model. Light from all around, and rectangles of it, are reflected by the standard material
// that looks most alike. Shadows, fog, tone mapping, normal maps and all else are three.js's own.
export function createNodeMaterial(THREE) {
  const {TSL} = THREE, {core} = model;
  const maps = Object.fromEntries(model.textures.map((texture) => [texture.name, tables(THREE, texture)]));
  const read = (name, u, v, w) => maps[name].isData3DTexture
    ? TSL.texture3D(maps[name], TSL.vec3(u, v, w)).level(0) : TSL.texture(maps[name], TSL.vec2(u, v)).level(0);

  // Tangent, bitangent and normal as rows: what turns a direction of the view into the local frame.
  const frame = (geometry) => {
    const n = TSL.normalView, given = TSL.normalGeometry;
    const along = geometry.hasAttribute("tangent") ? TSL.attribute("tangent", "vec4").xyz
                                                   : TSL.vec3(given.z, 0, given.x.negate());
    const seen = TSL.modelViewMatrix.mul(TSL.vec4(along, 0)).xyz;
    const t = seen.sub(n.mul(seen.dot(n))).normalize().toVar(), s = n.cross(t).toVar();
    return (w) => TSL.vec3(t.dot(w), s.dot(w), n.dot(w));
  };
  class Lighting extends THREE.PhysicalLightingModel {
    start(builder) {
      this.local = frame(builder.geometry);
      this.wo = this.local(TSL.positionViewDirection).toVar();
      super.start(builder);
    }
    direct({lightDirection, lightColor, reflectedLight}) {
      const wi = this.local(lightDirection).toVar();
      const value = reflectance(TSL, read, wi, this.wo);
      reflectedLight.directSpecular.addAssign(value.mul(wi.z.max(0)).mul(lightColor));
    }
  }
  class Material extends THREE.MeshPhysicalNodeMaterial {
    setupLightingModel() {
      return new Lighting(this.useClearcoat, this.useSheen, this.useIridescence, this.useAnisotropy);
    }
  }
  const material = new Material({name: model.name, ...core});
  material.color.setRGB(...model.color, THREE.LinearSRGBColorSpace);
  return material;
}

