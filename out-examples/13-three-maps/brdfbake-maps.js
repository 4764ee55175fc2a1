// A plugin for GLTFLoader of three.js: materials read the filtered maps that brdfbake wrote into the scene (BRDFBAKE_lookup_tables)
// in place of their core roughness and normal textures, whose levels the engine makes by plain means.
//
//     loader.register((parser) => new BrdfbakeMaps(parser));
//
// Reads KTX2 files of 8 and 16 bits; 16 bits become halves, for WebGL filters no others of this size.

import { DataTexture, DataUtils, FileLoader, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, LoaderUtils } from 'three';
import { MeshPhysicalMaterial, RedFormat, RGBAFormat, RGFormat, UnsignedByteType } from 'three';
import { read } from 'three/addons/libs/ktx-parse.module.js';

/** Format of three.js, and 16 bits or not, by the format of Vulkan. */
const FORMATS = { 9: [RedFormat, 0], 16: [RGFormat, 0], 37: [RGBAFormat, 0], 70: [RedFormat, 1], 77: [RGFormat, 1], 91: [RGBAFormat, 1] };

/** The texture in a KTX2 file, with all of its levels, sampled as `like` is. */
function texture(bytes, like) {
    const file = read(bytes);
    const [format, wide] = FORMATS[file.vkFormat] ?? [];
    if (format === undefined) throw new Error(`BrdfbakeMaps: no texture of VkFormat ${file.vkFormat}`);
    const codes = (data) => {
        if (!wide) return data.slice();
        return new Uint16Array(data.slice().buffer).map((code) => DataUtils.toHalfFloat(code / 65535));
    };
    const level = ({ levelData }, k) => ({
        data: codes(levelData),
        width: Math.max(1, file.pixelWidth >> k),
        height: Math.max(1, file.pixelHeight >> k),
    });
    const mipmaps = file.levels.map(level);
    const { data, width, height } = mipmaps[0];
    const made = new DataTexture(data, width, height, format, wide ? HalfFloatType : UnsignedByteType);
    made.mipmaps = mipmaps;
    Object.assign(made, { magFilter: LinearFilter, minFilter: LinearMipmapLinearFilter, unpackAlignment: 1, needsUpdate: true });
    if (like) {
        Object.assign(made, { channel: like.channel, wrapS: like.wrapS, wrapT: like.wrapT, anisotropy: like.anisotropy });
        Object.assign(made, { rotation: like.rotation, matrixAutoUpdate: like.matrixAutoUpdate });
        made.offset.copy(like.offset);
        made.repeat.copy(like.repeat);
        made.center.copy(like.center);
        made.matrix.copy(like.matrix);
    }
    return made;
}

/** three.js leaves the tangents of an anisotropic lobe in the surface: here they are turned with the normal that a map gives. */
class Turned extends MeshPhysicalMaterial {
    onBeforeCompile(shader) {
        const turn = `material.anisotropyT = normalize(material.anisotropyT - normal * dot(material.anisotropyT, normal));
            material.anisotropyB = cross(normal, material.anisotropyT);`;
        shader.fragmentShader = shader.fragmentShader.replace('#include <lights_physical_fragment>', `$&\n${turn}`);
    }
}

export class BrdfbakeMaps {
    constructor(parser) {
        this.name = 'BRDFBAKE_lookup_tables';
        this.parser = parser;
        this.object = parser.json.extensions?.[this.name];
    }

    /** What a material reads, and the files of its map by kind. */
    use(index) {
        const own = this.object?.materials.find((entry) => entry.material === index && entry.map !== undefined);
        const files = own && this.object.maps[own.map].files.filter((file) => file.container === 'ktx2');
        return files?.length ? { own, files: Object.fromEntries(files.map((file) => [file.map, file])) } : null;
    }

    async bytes(file) {
        if (file.bufferView !== undefined) return new Uint8Array(await this.parser.getDependency('bufferView', file.bufferView));
        const loader = new FileLoader(this.parser.options.manager).setResponseType('arraybuffer');
        return new Uint8Array(await loader.loadAsync(LoaderUtils.resolveURL(file.uri, this.parser.options.path)));
    }

    /** Anisotropy is a matter of the physical material. */
    getMaterialType(index) {
        return this.use(index)?.files.anisotropy ? Turned : null;
    }

    /** The material of the core, with its maps in place of textures. */
    loadMaterial(index) {
        const use = this.use(index);
        if (!use) return null;
        return this.parser.loadMaterial(index).then(async (material) => {
            const like = material.roughnessMap ?? material.normalMap;
            const { roughness, normal, anisotropy } = use.files;
            material.roughnessMap = texture(await this.bytes(roughness), like);
            material.roughness = use.own.roughnessFactor;
            if (normal) {
                material.normalMap = texture(await this.bytes(normal), like);
                material.normalScale.setScalar(use.own.normalScale);
            }
            if (anisotropy) {
                material.anisotropyMap = texture(await this.bytes(anisotropy), like);
                Object.assign(material, { anisotropy: 1, anisotropyRotation: 0 });
            }
            return material;
        });
    }
}
