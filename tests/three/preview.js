// The scene of `brdfbake preview` in three.js: a sphere of radius 1, or a mesh inside it, seen without perspective from +z, under the
// built-in sky or a furnace, with or without the panel. The sky and the panel are those of src/pipeline/preview/environment.rs.

import * as THREE from 'three';
import { GLTFLoader } from './three/examples/jsm/loaders/GLTFLoader.js';
import { RectAreaLightUniformsLib } from './three/examples/jsm/lights/RectAreaLightUniformsLib.js';

const renderer = new THREE.WebGLRenderer({ antialias: false });
renderer.toneMapping = THREE.NoToneMapping;
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
RectAreaLightUniformsLib.init();

const SKY = /* glsl */ `
    vec3 sky(vec3 w) {
        float up = w.y, sun = dot(w, vec3(0.6, 0.48, 0.64));
        return vec3(0.42, 0.45, 0.51) + vec3(0.1, 0.13, 0.2) * up + vec3(0.16, 0.12, 0.05) * sun + vec3(0.24, 0.18, 0.1) * (sun * sun - 1.0 / 3.0);
    }`;

function environment(furnace) {
    const material = new THREE.ShaderMaterial({
        side: THREE.BackSide,
        vertexShader: 'varying vec3 along; void main() { along = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
        fragmentShader: `varying vec3 along; ${SKY} void main() { gl_FragColor = vec4(${furnace ? 'vec3(1.0)' : 'sky(normalize(along))'}, 1.0); }`,
    });
    const scene = new THREE.Scene();
    scene.add(new THREE.Mesh(new THREE.BoxGeometry(10, 10, 10), material));
    return new THREE.PMREMGenerator(renderer).fromScene(scene).texture;
}

/** Four numbers of every pixel, rows from the top. */
function pixels(scene, size) {
    const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 10);
    camera.position.z = 5;
    const target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType });
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const all = new Float32Array(4 * size * size);
    renderer.readRenderTargetPixels(target, 0, 0, size, size, all);
    renderer.setRenderTarget(null);
    target.dispose();
    const rows = Array.from({ length: size }, (_, y) => Array.from(all.subarray(4 * size * (size - 1 - y), 4 * size * (size - y))));
    return rows.flat();
}

/** An object in [-1, 1] in its light. */
function lit(object, { texture, panel }) {
    const scene = new THREE.Scene();
    scene.environment = texture;
    scene.add(object);
    if (panel) {
        const light = new THREE.RectAreaLight(0xffffff, 1, 2.4, 1.6);
        light.color.setRGB(1.5, 1.4, 1.2, THREE.LinearSRGBColorSpace);
        light.position.set(-2, 1.6, 2.4);
        light.lookAt(0, 0, 0);
        scene.add(light);
    }
    return scene;
}

/** Linear red, green, blue and coverage of each sphere. */
window.spheres = ({ size, surfaces, furnace, panel }) => {
    const texture = environment(furnace);
    const geometry = new THREE.IcosahedronGeometry(1, 63).toNonIndexed();
    geometry.computeVertexNormals();
    return surfaces.map(({ base, metallic, roughness }) => {
        const material = new THREE.MeshStandardMaterial({ metalness: metallic, roughness });
        material.color.setRGB(...base, THREE.LinearSRGBColorSpace);
        return pixels(lit(new THREE.Mesh(geometry, material), { texture, panel }), size);
    });
};

/** The same of the meshes of a glTF file, moved and shrunk into the unit sphere as `preview --mesh` does; and their normals, from 0 to 1. */
window.mesh = async ({ size, url, panel }) => {
    const { scene } = await new GLTFLoader().loadAsync(url);
    scene.updateMatrixWorld(true);
    const points = [];
    scene.traverse((node) => {
        const position = node.geometry?.attributes.position;
        for (let i = 0; i < (position?.count ?? 0); i++) points.push(new THREE.Vector3().fromBufferAttribute(position, i).applyMatrix4(node.matrixWorld));
    });
    const middle = new THREE.Box3().setFromPoints(points).getCenter(new THREE.Vector3());
    const radius = Math.max(...points.map((p) => p.distanceTo(middle)));
    const group = new THREE.Group();
    group.add(scene);
    group.scale.setScalar(1 / radius);
    group.position.copy(middle).multiplyScalar(-1 / radius);
    const whole = lit(group, { texture: environment(false), panel });
    const rendered = pixels(whole, size);
    whole.overrideMaterial = new THREE.MeshNormalMaterial();
    return { rendered, normals: pixels(whole, size) };
};

/** The pixels of a PNG: width, height, RGBA. */
window.decoded = async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d', { colorSpace: 'srgb' });
    context.drawImage(image, 0, 0);
    return { width: image.width, height: image.height, data: Array.from(context.getImageData(0, 0, image.width, image.height).data) };
};

window.ready = true;
