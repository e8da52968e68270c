## How a body responds to light from anywhere, as the file of `sssgen bake fluence --relit` has it: its numbers are explained
## where they are made, in sssgen's light_response.py. A vector here has red, green, blue and 0.
class Response:
	## π times the mean radiance of light that has not been scattered, relative to its irradiance.
	const UNSCATTERED := 0.25
	## The parameters of the technique.
	var parameters: Dictionary
	var size: Vector3i
	var count: int
	## The voxels that count, in object space.
	var places: PackedVector3Array
	## For each texel the voxel that counts for it, and the distance from the surface, 0 to 1.
	var _nearest: PackedInt32Array
	var _distance: PackedByteArray
	## For each voxel its numbers in groups of four: a matrix weights a group at once.
	var _numbers := PackedVector4Array()
	var _groups: int
	## For each direction of an octahedral map, with a border that repeats its edges: the constant, and the matrices of the
	## groups.
	var _side: int
	var _constants := PackedVector4Array()
	var _matrices: Array[Projection] = []
	## Of the map of light that has not been scattered: for each direction with a border the texel without it, for each voxel
	## the roots of the texels, and for each root the light.
	var _arriving_side: int
	var _texels: PackedInt32Array
	var _arriving: PackedByteArray
	var _shares := PackedVector4Array()
	## For each voxel the weights of nine harmonics.
	var _around := PackedVector4Array()
	## The texels of the map around a direction, and their weights.
	var _corners := PackedInt32Array([0, 0, 0, 0])
	var _weights := Vector4.ZERO

	## The response of a file, beside which its JSON lies; null where one of them is missing or of another kind.
	static func load_from(path: String) -> Response:
		var facts: Variant = JSON.parse_string(FileAccess.get_file_as_string(path + ".json"))
		var file := FileAccess.get_file_as_bytes(path)
		if file.is_empty() or not (facts is Dictionary and facts.has("arrays") and facts["arrays"].has("arriving")):
			return null
		if file.size() != int(facts["file"]["bytes"]): # the JSON of another bake
			return null
		var data := file.decompress_dynamic(-1, FileAccess.COMPRESSION_DEFLATE)
		return Response.new(data, facts) if not data.is_empty() else null

	func _init(data: PackedByteArray, facts: Dictionary) -> void:
		parameters = facts["parameters"]
		var about: Dictionary = facts["arrays"]
		var shape: Array = about["nearest"]["shape"]
		size = Vector3i(int(shape[2]), int(shape[1]), int(shape[0]))
		_nearest = _whole_numbers(data, about["nearest"])
		_distance = _bytes(data, about["distance"])
		_arriving = _bytes(data, about["arriving"])
		_arriving_side = roundi(sqrt(about["arriving"]["shape"][1]))
		_texels = _with_border(_arriving_side)
		var cells := _whole_numbers(data, about["cells"])
		count = cells.size()
		var low := _vector(facts["box_min"])
		var step := (_vector(facts["box_max"]) - low) / Vector3(size)
		for cell in cells:
			@warning_ignore("integer_division")
			var place := Vector3i(cell % size.x, cell / size.x % size.y, cell / (size.x * size.y))
			places.append(low + (Vector3(place) + 0.5 * Vector3.ONE) * step)
		var powers := _vector(facts["powers"])
		for root in 256:
			var share := maxf(root * facts["highest"] / 255.0, 3e-5) ** 2.0
			# a share above 1 is light that a curved surface focuses: the same for all channels
			var shares := Vector3(share ** powers.x, share ** powers.y, share ** powers.z) if share < 1.0 else Vector3.ONE * share
			_shares.append(UNSCATTERED * Vector4(shares.x, shares.y, shares.z, 0.0))
		_read_numbers(_bytes(data, about["latents"]))
		_read_table(data, about["table"])
		_read_surroundings(_bytes(data, about["surroundings"]), facts["largest"])

	func _read_numbers(stored: PackedByteArray) -> void:
		@warning_ignore("integer_division")
		var rank := stored.size() / count
		_groups = ceili(rank / 4.0)
		_numbers.resize(count * _groups)
		for number in rank:
			@warning_ignore("integer_division")
			var group := number / 4
			for voxel in count:
				_numbers[voxel * _groups + group][number % 4] = stored[number * count + voxel] / 255.0

	func _read_table(data: PackedByteArray, about: Dictionary) -> void:
		_side = roundi(sqrt(about["shape"][0]))
		var rows := int(about["shape"][1])
		for texel in _with_border(_side):
			var colors := PackedVector4Array()
			for row in rows:
				var at := int(about["start"]) + 6 * (texel * rows + row)
				colors.append(Vector4(data.decode_half(at), data.decode_half(at + 2), data.decode_half(at + 4), 0.0))
			colors.resize(1 + 4 * _groups)
			_constants.append(colors[0])
			for first in range(1, colors.size(), 4):
				_matrices.append(Projection(colors[first], colors[first + 1], colors[first + 2], colors[first + 3]))

	## The texels of an octahedral map with a border: beyond an edge lies the same edge, reversed.
	static func _with_border(side: int) -> PackedInt32Array:
		var texels := PackedInt32Array()
		for y in range(-1, side + 1):
			for x in range(-1, side + 1):
				var beside := x < 0 or x >= side
				var above := y < 0 or y >= side
				var column := clampi(side - 1 - x if above and not beside else x, 0, side - 1)
				texels.append(column + side * clampi(side - 1 - y if beside and not above else y, 0, side - 1))
		return texels

	func _read_surroundings(stored: PackedByteArray, largest: Array) -> void:
		_around.resize(9 * count)
		for harmonic in 9:
			for channel in 3:
				var first := (3 * harmonic + channel) * count
				var scale: float = largest[harmonic][channel] / 127.0
				for voxel in count:
					_around[9 * voxel + harmonic][channel] = stored.decode_s8(first + voxel) * scale

	static func _bytes(data: PackedByteArray, about: Dictionary) -> PackedByteArray:
		var length := 1
		for extent: float in about["shape"]:
			length *= int(extent)
		return data.slice(int(about["start"]), int(about["start"]) + length * (4 if about["type"] == "uint32" else 2 if about["type"] == "uint16" else 1))

	static func _whole_numbers(data: PackedByteArray, about: Dictionary) -> PackedInt32Array:
		var stored := _bytes(data, about)
		if about["type"] == "uint32":
			return stored.to_int32_array()
		var numbers := PackedInt32Array()
		for at in range(0, stored.size(), 2):
			numbers.append(stored.decode_u16(at))
		return numbers

	static func _vector(values: Array) -> Vector3:
		return Vector3(values[0], values[1], values[2])

	## Finds the texels around a direction of any length, in a map with a border.
	func _find(way: Vector3, side: int) -> void:
		var whole := maxf(absf(way.x) + absf(way.y) + absf(way.z), 1e-20)
		var across := way.x / whole
		var up := way.y / whole
		if way.z < 0.0:
			var flat := across
			across = (1.0 - absf(up)) * (-1.0 if way.x < 0.0 else 1.0)
			up = (1.0 - absf(flat)) * (-1.0 if way.y < 0.0 else 1.0)
		var column := (0.5 * across + 0.5) * side + 0.5
		var row := (0.5 * up + 0.5) * side + 0.5
		var x := int(column)
		var y := int(row)
		column -= x
		row -= y
		var first := y * (side + 2) + x
		_corners[0] = first
		_corners[1] = first + 1
		_corners[2] = first + side + 2
		_corners[3] = first + side + 3
		_weights = Vector4((1.0 - column) * (1.0 - row), column * (1.0 - row), (1.0 - column) * row, column * row)

	## The light in the voxels from a distant light of the irradiance 1.
	func from_afar(way: Vector3) -> PackedVector4Array:
		_find(way, _side)
		var start := Vector4.ZERO
		var matrices: Array[Projection] = []
		for group in _groups:
			var mixed := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
			for corner in 4:
				for i in 4:
					mixed[i] += _weights[corner] * _matrices[_corners[corner] * _groups + group][i]
			matrices.append(mixed)
		for corner in 4:
			start += _weights[corner] * _constants[_corners[corner]]
		var light := PackedVector4Array()
		light.resize(count)
		light.fill(start)
		for group in _groups:
			var matrix := matrices[group]
			var at := group
			for voxel in count:
				light[voxel] += matrix * _numbers[at]
				at += _groups
		if not _arriving.is_empty():
			_find(way, _arriving_side)
			var a := _texels[_corners[0]]
			var b := _texels[_corners[1]]
			var c := _texels[_corners[2]]
			var d := _texels[_corners[3]]
			var w := _weights
			var at := 0
			for voxel in count:
				light[voxel] += _shares[int(w.x * _arriving[at + a] + w.y * _arriving[at + b] + w.z * _arriving[at + c] + w.w * _arriving[at + d] + 0.5)]
				at += _arriving_side * _arriving_side
		return light

	## The same of a light at a place in object space; `strengths` are the irradiances in the voxels.
	func from_near(place: Vector3, strengths: PackedFloat32Array) -> PackedVector4Array:
		var light := PackedVector4Array()
		light.resize(count)
		for voxel in count:
			if strengths[voxel] == 0.0:
				continue
			var way := place - places[voxel]
			_find(way, _side)
			var sum := Vector4.ZERO
			for corner in 4:
				var texel := _corners[corner]
				var of_corner := _constants[texel]
				for group in _groups:
					of_corner += _matrices[texel * _groups + group] * _numbers[voxel * _groups + group]
				sum += _weights[corner] * of_corner
			if not _arriving.is_empty():
				_find(way, _arriving_side)
				var at := voxel * _arriving_side * _arriving_side
				var root := 0.5
				for corner in 4:
					root += _weights[corner] * _arriving[at + _texels[_corners[corner]]]
				sum += _shares[int(root)]
			light[voxel] = strengths[voxel] * sum
		return light

	## The same of surroundings: `light` has for each harmonic the integral of the light times the harmonic.
	func from_around(light: PackedVector4Array) -> PackedVector4Array:
		var result := PackedVector4Array()
		result.resize(count)
		var at := 0
		for voxel in count:
			var sum := Vector4.ZERO
			for harmonic in 9:
				sum += light[harmonic] * _around[at + harmonic]
			result[voxel] = sum
			at += 9
		return result

	## The slices of the volume, for the light in the voxels.
	func slices(light: PackedVector4Array) -> Array[Image]:
		var colors := PackedColorArray()
		colors.resize(count)
		for voxel in count:
			var color := light[voxel]
			colors[voxel] = Color(maxf(color.x, 0.0), maxf(color.y, 0.0), maxf(color.z, 0.0))
		var texels := PackedColorArray()
		texels.resize(_nearest.size())
		for texel in _nearest.size():
			texels[texel] = Color(colors[_nearest[texel]], _distance[texel] / 255.0)
		var bytes := texels.to_byte_array()
		var length := 16 * size.x * size.y
		var result: Array[Image] = []
		for z in size.z:
			var slice := bytes.slice(z * length, (z + 1) * length)
			var image := Image.create_from_data(size.x, size.y, false, Image.FORMAT_RGBAF, slice)
			image.convert(Image.FORMAT_RGBAH)
			result.append(image)
		return result
