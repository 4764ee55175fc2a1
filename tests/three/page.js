// What runs in the browser: spheres and patches in a white furnace, rendered by three.js as it is. The driver is furnace.mjs.

import * as THREE from 'three';
import { getDFGLUT } from './three/src/renderers/shaders/DFGLUTData.js';

const renderer = new THREE.WebGLRenderer({ antialias: false });
renderer.toneMapping = THREE.NoToneMapping;
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;

/** Red of every pixel, the first row at the bottom. */
function pixels(scene, camera, width, height, channel = 0) {
    const target = new THREE.WebGLRenderTarget(width, height, {
        type: THREE.FloatType,
        minFilter: THREE.NearestFilter,
        magFilter: THREE.NearestFilter,
    });
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const all = new Float32Array(4 * width * height);
    renderer.readRenderTargetPixels(target, 0, 0, width, height, all);
    renderer.setRenderTarget(null);
    target.dispose();
    return all.filter((_, i) => i % 4 === channel);
}

/** A camera that sees [0, width] x [0, height] without perspective: the view direction is +z everywhere. */
function orthographic(width, height) {
    const camera = new THREE.OrthographicCamera(0, width, height, 0, 0, 1e4);
    camera.position.z = 5e3;
    return camera;
}

/** The table that the renderer reads: width, height, and its half floats. */
window.table = () => {
    const { width, height, data } = getDFGLUT().image;
    return { width, height, data: Array.from(data) };
};

/**
 * A row of metal spheres in a uniform white environment, prefiltered by three.js.
 *
 * Facets are flat, so that a pixel has one normal and the renderer does not widen the roughness by its change.
 * Returns for every reflectance at normal incidence the radiance of every pixel, and the cosine there (0 outside the spheres).
 */
window.spheres = ({ radius, roughness, f0 }) => {
    const [width, height] = [2 * radius * roughness.length, 2 * radius];
    const camera = orthographic(width, height);
    const white = new THREE.Scene();
    white.background = new THREE.Color(1, 1, 1);
    const environment = new THREE.PMREMGenerator(renderer).fromScene(white).texture;
    const geometry = new THREE.IcosahedronGeometry(radius, 31);
    geometry.computeVertexNormals();
    const row = (material) => {
        const scene = new THREE.Scene();
        scene.environment = environment;
        roughness.forEach((r, i) => {
            const mesh = new THREE.Mesh(geometry, material(r));
            mesh.position.set((2 * i + 1) * radius, radius, 0);
            scene.add(mesh);
        });
        return scene;
    };
    const normals = pixels(row(() => new THREE.MeshNormalMaterial()), camera, width, height, 2);
    const radiance = f0.map((value) => {
        const metal = (r) => {
            const material = new THREE.MeshStandardMaterial({ metalness: 1, roughness: r });
            material.color.setRGB(value, value, value, THREE.LinearSRGBColorSpace);
            return material;
        };
        return Array.from(pixels(row(metal), camera, width, height));
    });
    return { width, height, cosine: Array.from(normals, (z) => (z === 0 ? 0 : 2 * z - 1)), radiance };
};

/**
 * White metal patches, one pixel each, under many directional lights that together are a uniform white sphere of radiance 1.
 *
 * x is the cosine, (i + 1/2) / n; y is the roughness. The lights lie on a Fibonacci spiral, each with its share of the sphere.
 */
window.patches = ({ cosines, roughness, lights, batch }) => {
    const camera = orthographic(cosines, roughness.length);
    const scene = new THREE.Scene();
    roughness.forEach((r, y) => {
        const [position, normal, index] = [[], [], []];
        for (let x = 0; x < cosines; x++) {
            const mu = (x + 0.5) / cosines;
            for (const [dx, dy] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
                position.push(x + dx, y + dy, 0);
                normal.push(Math.sqrt(1 - mu * mu), 0, mu);
            }
            index.push(...[0, 1, 2, 0, 2, 3].map((i) => 4 * x + i));
        }
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
        geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normal, 3));
        geometry.setIndex(index);
        scene.add(new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ metalness: 1, roughness: r })));
    });
    const lamps = Array.from({ length: batch }, () => new THREE.DirectionalLight(0xffffff, (4 * Math.PI) / lights));
    lamps.forEach((lamp) => scene.add(lamp));
    const [width, height] = [cosines, roughness.length];
    const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
    const sum = new Float64Array(width * height);
    const read = new Float32Array(4 * width * height);
    for (let first = 0; first < lights; first += batch) {
        lamps.forEach((lamp, i) => {
            const z = 1 - (2 * (first + i) + 1) / lights;
            const [s, phi] = [Math.sqrt(1 - z * z), (first + i) * Math.PI * (3 - Math.sqrt(5))];
            lamp.position.set(s * Math.cos(phi), z, s * Math.sin(phi));
        });
        renderer.setRenderTarget(target);
        renderer.setClearColor(0, 0);
        renderer.clear();
        renderer.render(scene, camera);
        renderer.readRenderTargetPixels(target, 0, 0, width, height, read);
        for (let i = 0; i < sum.length; i++) sum[i] += read[4 * i];
    }
    renderer.setRenderTarget(null);
    return Array.from({ length: height }, (_, y) => Array.from(sum.subarray(y * width, (y + 1) * width)));
};

/** Draws rows of spheres below each other, each with a line of text above it, and returns the PNG. */
window.draw = ({ rows, width, height }) => {
    const canvas = document.createElement('canvas');
    const line = 18;
    [canvas.width, canvas.height] = [width, rows.length * (height + line)];
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.fillStyle = '#000';
    context.font = '12px sans-serif';
    rows.forEach(({ text, rgb, labels }, n) => {
        const top = n * (height + line);
        context.fillText(text, 4, top + 13);
        const image = context.createImageData(width, height);
        for (let y = 0; y < height; y++) {
            for (let x = 0; x < width; x++) {
                const from = 3 * ((height - 1 - y) * width + x);
                image.data.set([...rgb.slice(from, from + 3), 255], 4 * (y * width + x));
            }
        }
        context.putImageData(image, 0, top + line);
        context.fillStyle = '#000';
        context.textAlign = 'center';
        labels.forEach((label, i) => context.fillText(label, ((i + 0.5) * width) / labels.length, top + line + height / 2 + 4));
        context.textAlign = 'left';
    });
    return canvas.toDataURL('image/png').split(',')[1];
};

window.ready = true;
