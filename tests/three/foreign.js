// What runs in the browser: its own PNG decoder, GLSL through WebGL 2, WGSL through WebGPU. The driver is foreign.mjs.

const canvas = document.createElement('canvas');
const gl = canvas.getContext('webgl2');
gl.getExtension('EXT_color_buffer_float');

/** Draws a triangle over width x height pixels of a 32-bit float target and reads it back. */
function drawn(fragment, width, height, set) {
    const program = gl.createProgram();
    const vertex = '#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }';
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    set(program);
    const target = gl.createTexture();
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.viewport(0, 0, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    const fault = gl.getError();
    if (fault !== gl.NO_ERROR) throw new Error(`WebGL error ${fault}`);
    return Array.from(pixels);
}

/** A picture on a canvas of half floats, which keeps 16 bits and converts the gamma of the file to sRGB; none if there is no such canvas. */
window.deep = async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const { width, height } = image;
    const context = new OffscreenCanvas(width, height).getContext('2d', { colorType: 'float16', colorSpace: 'srgb' });
    if (context.getContextAttributes?.().colorType !== 'float16') return null;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, width, height, { pixelFormat: 'rgba-float16' });
    return { width, height, pixels: Array.from(data, Number) };
};

/** Codes of a picture in [0, 1], as a texture holds them: the browser's decoder, no colour conversion, no premultiplication. */
window.picture = async (url) => {
    const blob = await (await fetch(url)).blob();
    const bitmap = await createImageBitmap(blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    const { width, height } = bitmap;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    const source = `#version 300 es
        precision highp float;
        uniform highp sampler2D picture;
        out vec4 o;
        void main() { o = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }`;
    // the bitmap's first row is the first row of the texture
    const pixels = drawn(source, width, height, (p) => gl.uniform1i(gl.getUniformLocation(p, 'picture'), 0));
    return { width, height, pixels };
};

const call = ({ arguments: n }, of) => Array.from({ length: n }, (_, i) => `${of}${'.xyzw'.slice(1)[i]}`).join(', ');
const pad = (at) => at.flatMap((p) => [...p, 0, 0, 0, 0].slice(0, 4));

/** What the GLSL lookup reads at the points: channels of a point behind each other. */
window.glsl = (table) => {
    const n = table.at.length;
    const swizzle = 'xyzw'.slice(0, table.channels);
    const source = `#version 300 es
        precision highp float;
        precision highp int;
        ${table.glsl}
        uniform vec4 points[${n}];
        out vec4 o;
        void main() {
            vec4 a = points[int(gl_FragCoord.x)];
            o = vec4(0.0);
            o.${swizzle} = dfg_lookup(${call(table, 'a.')});
        }`;
    const pixels = drawn(source, n, 1, (p) => gl.uniform4fv(gl.getUniformLocation(p, 'points'), pad(table.at)));
    return pixels.filter((_, i) => i % 4 < table.channels);
};

/** The same with WGSL; nothing if there is no WebGPU. */
window.wgsl = async (tables) => {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return null;
    const device = await adapter.requestDevice();
    const results = [];
    for (const table of tables) {
        const n = table.at.length;
        const store = ['o[i].x = r;', 'o[i] = vec4f(r, 0.0, 0.0);', 'o[i] = vec4f(r, 0.0);', 'o[i] = r;'][table.channels - 1];
        const code = `${table.wgsl}
            @group(0) @binding(0) var<storage, read> points: array<vec4f>;
            @group(0) @binding(1) var<storage, read_write> o: array<vec4f>;
            @compute @workgroup_size(64) fn run(@builtin(global_invocation_id) id: vec3u) {
                let i = id.x;
                if (i >= ${n}u) { return; }
                let a = points[i];
                let r = dfg_lookup(${call(table, 'a.')});
                ${store}
            }`;
        const module = device.createShaderModule({ code });
        const faults = (await module.getCompilationInfo()).messages.filter((m) => m.type === 'error');
        if (faults.length) throw new Error(`${table.name}: ${faults[0].message}`);
        const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'run' } });
        const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;
        const points = device.createBuffer({ size: 16 * n, usage: STORAGE | COPY_DST });
        device.queue.writeBuffer(points, 0, new Float32Array(pad(table.at)));
        const out = device.createBuffer({ size: 16 * n, usage: STORAGE | COPY_SRC });
        const read = device.createBuffer({ size: 16 * n, usage: COPY_DST | MAP_READ });
        const entries = [points, out].map((buffer, binding) => ({ binding, resource: { buffer } }));
        const encoder = device.createCommandEncoder();
        const pass = encoder.beginComputePass();
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
        pass.dispatchWorkgroups(Math.ceil(n / 64));
        pass.end();
        encoder.copyBufferToBuffer(out, 0, read, 0, 16 * n);
        device.queue.submit([encoder.finish()]);
        await read.mapAsync(GPUMapMode.READ);
        results.push(Array.from(new Float32Array(read.getMappedRange())).filter((_, i) => i % 4 < table.channels));
    }
    return results;
};

window.ready = true;
