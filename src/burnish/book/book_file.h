// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <burnish/book/material_book.h>
#include <burnish/file.h>

namespace burnish {

/// The file of a book, CBOR [RFC8949]: ["burnish book", version, sides, axes, names, weights]. sides: nodes along
/// theta_h, theta_d and phi_d. An axis of colour: [mean (halves), residual, number of components, components (signed
/// bytes), [scales, steps, deviations]]. weights: signed bytes, those of each material in turn. parse_book restores
/// the book to the last bit.
std::string format_book(const MaterialBook& book);

/// Throws Error, naming file and offset, if the bytes are no such file or contradict themselves in any way. Memory
/// taken is at most a fixed multiple of the file's size.
MaterialBook parse_book(const FileBytes& file);

/// True if the bytes start as a book's file does.
bool looks_like_book(std::span<const std::byte> head) noexcept;

}  // namespace burnish
