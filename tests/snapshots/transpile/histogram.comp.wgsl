// histogram
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Texel {
    place: vec2f,
    value: f32,
    weight: u32,
}

struct Texels {
    texels: array<Texel>,
}

struct Bins {
    bins: array<atomic<u32>, 16>,
}

struct Extremes {
    extremes: array<atomic<i32>>,
}

struct Material {
    count: u32,
    scale: f32,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var<storage, read> data: Texels;
@group(1) @binding(2) var<storage, read_write> bins_buffer: Bins;
@group(1) @binding(3) var<storage, read_write> extremes_buffer: Extremes;
var<workgroup> counts: array<atomic<u32>, 16>;
var<workgroup> lowest: atomic<i32>;
var<private> LocalInvocationIndex: u32;
var<private> WorkGroupID: vec3u;

fn add(bin: u32, weight: u32) {
    atomicAdd(&counts[bin], weight);
}

fn main_() {
    let lane = LocalInvocationIndex;
    let i = WorkGroupID.x * 64u + lane;
    if (lane < 16u) {
        atomicStore(&counts[lane], 0u);
    }
    if (lane == 0u) {
        atomicStore(&lowest, 1000);
    }
    workgroupBarrier();
    if (i < material.count) {
        let texel = data.texels[i];
        add(u32(clamp(texel.value * material.scale, 0.0, 15.0)), texel.weight);
        atomicMin(&lowest, i32(texel.place.x));
        var before: i32;
        before = atomicMax(&extremes_buffer.extremes[1], i32(texel.place.y));
        if (before < 0) {
            atomicOr(&extremes_buffer.extremes[2], 1);
        }
        var seen: u32;
        loop {
            let swapped = atomicCompareExchangeWeak(&bins_buffer.bins[15], 0u, 0u);
            if (swapped.exchanged || swapped.old_value != 0u) {
                seen = swapped.old_value;
                break;
            }
        }
        atomicXor(&extremes_buffer.extremes[3], i32(seen) * 0 + i32(i));
        var old: i32;
        old = atomicExchange(&extremes_buffer.extremes[5], 7);
        atomicStore(&extremes_buffer.extremes[4], old);
    }
    workgroupBarrier();
    if (lane < 16u && atomicLoad(&counts[lane]) > 0u) {
        atomicAdd(&bins_buffer.bins[lane], atomicLoad(&counts[lane]));
    }
    if (lane == 0u) {
        atomicMin(&extremes_buffer.extremes[0], atomicLoad(&lowest));
    }
}

@compute @workgroup_size(8, 8, 1)
fn compute_main(@builtin(local_invocation_index) LocalInvocationIndex_in: u32,
    @builtin(workgroup_id) WorkGroupID_in: vec3u) {
    LocalInvocationIndex = LocalInvocationIndex_in;
    WorkGroupID = WorkGroupID_in;
    main_();
}
