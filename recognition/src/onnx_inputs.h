#pragma once

#include <string>
#include <vector>

namespace hoist {

/** \brief Shapes of the inputs that an ONNX model declares, which OpenCV reads but does
 *  not tell; weights that are listed as inputs are left out.
 *
 * Reads ModelProto.graph (7), GraphProto.initializer (5) and .input (11),
 * ValueInfoProto down to the dimensions, of onnx.proto. \param bytes the whole file
 * \param shapes the answer; an unknown side is -1
 * \return false if the bytes are no protocol buffer, e.g. are cut off */
bool onnxInputs(const std::string& bytes, std::vector<std::vector<int>>& shapes);

} // namespace hoist
