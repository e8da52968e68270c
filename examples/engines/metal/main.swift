// Draws a material that `sssgen emit NAME --target metal -o out` has written on a ball, with the parameters' defaults and
// plain textures, and writes picture.ppm:  swiftc main.swift -o draw && ./draw ../../../out/paper_lantern
import Foundation
import Metal
import simd

struct Camera {
    var viewProjection: float4x4
    var inverseViewProjection: float4x4
    var position: SIMD3<Float>
    var time: Float = 0
}
struct Lights {
    var ambient: SIMD3<Float>
    var count: Int32
    var positions: (SIMD4<Float>, SIMD4<Float>, SIMD4<Float>, SIMD4<Float>)  // w = 1: a place; w = 0: a direction
    var colors: (SIMD4<Float>, SIMD4<Float>, SIMD4<Float>, SIMD4<Float>)
}
struct Object {
    var model = matrix_identity_float4x4
    var inverseModel = matrix_identity_float4x4
}

let base = CommandLine.arguments.dropFirst().first ?? "out/paper_lantern"
let device = MTLCreateSystemDefaultDevice()!
let options = MTLCompileOptions()
options.fastMathEnabled = false
let library = try device.makeLibrary(source: String(contentsOfFile: base + ".metal", encoding: .utf8), options: options)
let reflection = try JSONSerialization.jsonObject(
    with: Data(contentsOf: URL(fileURLWithPath: base + ".metal.reflection.json"))) as! [String: Any]

// The struct Material: each default at its offset, columns of matrices as vectors.
var material = [UInt8](repeating: 0, count: max(reflection["uniform_block_size"] as? Int ?? 0, 16))
for uniform in reflection["uniforms"] as! [[String: Any]] {
    let numbers = (uniform["default"] as! [NSNumber])
    let type = uniform["type"] as! String
    var offset = uniform["offset"] as! Int
    for (index, number) in numbers.enumerated() {
        if type.hasPrefix("mat3"), index > 0, index % 3 == 0 { offset += 4 }
        let bytes: [UInt8]
        if type.hasPrefix("b") {
            bytes = [number.boolValue ? 1 : 0]
        } else if type.hasPrefix("i") || type.hasPrefix("u") {
            bytes = withUnsafeBytes(of: UInt32(truncatingIfNeeded: number.int64Value)) { Array($0) }
        } else {
            bytes = withUnsafeBytes(of: number.floatValue) { Array($0) }
        }
        material.replaceSubrange(offset..<offset + bytes.count, with: bytes)
        offset += bytes.count
    }
}

// The ball: position, normal, tangent with its handedness, uv.
let (rings, sides) = (48, 96)
var vertices: [Float] = [], indices: [UInt32] = []
for ring in 0...rings {
    for side in 0...sides {
        let (u, v) = (Float(side) / Float(sides), Float(ring) / Float(rings))
        let (turn, tilt) = (2 * Float.pi * (u - 0.5), Float.pi * (v - 0.5))
        let normal = [cos(tilt) * sin(turn), sin(tilt), cos(tilt) * cos(turn)]
        vertices += normal + normal + [cos(turn), 0, -sin(turn), 1, u, v]
        if ring < rings && side < sides {
            let at = UInt32(ring * (sides + 1) + side), above = at + UInt32(sides + 1)
            indices += [at, at + 1, above + 1, at, above + 1, above]
        }
    }
}

let layout = MTLVertexDescriptor()
for (number, format, offset) in [(0, MTLVertexFormat.float3, 0), (1, .float3, 12), (2, .float4, 24), (3, .float2, 40)] {
    layout.attributes[number].format = format
    layout.attributes[number].offset = offset
    layout.attributes[number].bufferIndex = 0
}
layout.layouts[0].stride = 48
let description = MTLRenderPipelineDescriptor()
description.vertexDescriptor = layout
description.vertexFunction = library.makeFunction(name: "vertex_main")
description.fragmentFunction = library.makeFunction(name: "fragment_main")
description.colorAttachments[0].pixelFormat = .rgba8Unorm_srgb
description.depthAttachmentPixelFormat = .depth32Float
let pipeline = try device.makeRenderPipelineState(descriptor: description)

let size = 512
func target(_ format: MTLPixelFormat) -> MTLTexture {
    let made = MTLTextureDescriptor.texture2DDescriptor(pixelFormat: format, width: size, height: size, mipmapped: false)
    made.usage = .renderTarget
    made.storageMode = .private
    return device.makeTexture(descriptor: made)!
}
let pass = MTLRenderPassDescriptor()
pass.colorAttachments[0].texture = target(.rgba8Unorm_srgb)
pass.colorAttachments[0].loadAction = .clear
pass.colorAttachments[0].clearColor = MTLClearColor(red: 0.02, green: 0.025, blue: 0.035, alpha: 1)
pass.depthAttachment.texture = target(.depth32Float)
pass.depthAttachment.loadAction = .clear
let depth = MTLDepthStencilDescriptor()
depth.depthCompareFunction = .less
depth.isDepthWriteEnabled = true

// A camera on the z axis that looks at the origin; depth from 0 to 1.
let (near, far, focal, eye) = (Float(0.1), Float(100), 1 / tan(Float.pi * 35 / 360), SIMD3<Float>(0, 0, 4))
let projection = float4x4(
    [focal, 0, 0, 0], [0, focal, 0, 0], [0, 0, far / (near - far), -1], [0, 0, near * far / (near - far), 0])
var view = matrix_identity_float4x4
view.columns.3 = [-eye.x, -eye.y, -eye.z, 1]
var camera = Camera(viewProjection: projection * view, inverseViewProjection: (projection * view).inverse, position: eye)
var lights = Lights(
    ambient: [0.06, 0.07, 0.08], count: 2, positions: ([-0.8, 0.5, -1.6, 0], [2, 2.5, 3, 1], .zero, .zero),
    colors: ([1.3, 1.2, 1, 0], [6, 6, 6, 0], .zero, .zero))
var object = Object()

let commands = device.makeCommandQueue()!.makeCommandBuffer()!
let encoder = commands.makeRenderCommandEncoder(descriptor: pass)!
encoder.setRenderPipelineState(pipeline)
encoder.setDepthStencilState(device.makeDepthStencilState(descriptor: depth)!)
encoder.setFrontFacing(.counterClockwise)
encoder.setVertexBuffer(device.makeBuffer(bytes: vertices, length: 4 * vertices.count), offset: 0, index: 0)
encoder.setVertexBytes(&camera, length: MemoryLayout<Camera>.stride, index: 1)
encoder.setVertexBytes(&object, length: MemoryLayout<Object>.stride, index: 3)
encoder.setFragmentBytes(&camera, length: MemoryLayout<Camera>.stride, index: 1)
encoder.setFragmentBytes(&lights, length: MemoryLayout<Lights>.stride, index: 2)
encoder.setFragmentBytes(&object, length: MemoryLayout<Object>.stride, index: 3)
encoder.setFragmentBytes(material, length: material.count, index: 4)
for (number, texture) in (reflection["textures"] as! [[String: Any]]).enumerated() {
    let made = MTLTextureDescriptor.texture2DDescriptor(pixelFormat: .rgba8Unorm, width: 1, height: 1, mipmapped: false)
    made.textureType = (texture["type"] as! String) == "sampler3D" ? .type3D : .type2D
    let plain = device.makeTexture(descriptor: made)!
    let texels: [String: [UInt8]] = ["black": [0, 0, 0, 255], "gray": [128, 128, 128, 255], "bump": [128, 128, 255, 255]]
    let texel = texels[texture["default"] as! String] ?? [255, 255, 255, 255]
    plain.replace(region: MTLRegionMake3D(0, 0, 0, 1, 1, 1), mipmapLevel: 0, slice: 0, withBytes: texel, bytesPerRow: 4, bytesPerImage: 4)
    encoder.setFragmentTexture(plain, index: number)
    encoder.setFragmentSamplerState(device.makeSamplerState(descriptor: MTLSamplerDescriptor())!, index: number)
}
encoder.drawIndexedPrimitives(
    type: .triangle, indexCount: indices.count, indexType: .uint32,
    indexBuffer: device.makeBuffer(bytes: indices, length: 4 * indices.count)!, indexBufferOffset: 0)
encoder.endEncoding()
let pixels = device.makeBuffer(length: 4 * size * size)!
let blit = commands.makeBlitCommandEncoder()!
blit.copy(
    from: pass.colorAttachments[0].texture!, sourceSlice: 0, sourceLevel: 0, sourceOrigin: MTLOrigin(),
    sourceSize: MTLSize(width: size, height: size, depth: 1), to: pixels, destinationOffset: 0,
    destinationBytesPerRow: 4 * size, destinationBytesPerImage: 4 * size * size)
blit.endEncoding()
commands.commit()
commands.waitUntilCompleted()

var picture = Data("P6 \(size) \(size) 255\n".utf8)
let bytes = UnsafeRawBufferPointer(start: pixels.contents(), count: 4 * size * size)
for pixel in 0..<size * size { picture.append(contentsOf: bytes[4 * pixel..<4 * pixel + 3]) }
try picture.write(to: URL(fileURLWithPath: "picture.ppm"))
