// Whole files in and out; a file is replaced only when all of its new content is on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

/// Throws Error(io) naming the path and the system's reason.
Vector<std::uint8_t> read_bytes(const std::filesystem::path& path);
std::string read_text(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& path, std::string_view text);

/// Calls `write(temporary)` with a name beside `path`, then renames; removes the temporary file if that fails.
template <class Write>
void replace_file(const std::filesystem::path& path, Write&& write) {
  std::filesystem::path temporary = path;
  temporary += ".part";
  try {
    write(temporary);
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error) throw Error(Code::io, "cannot write '" + path.string() + "': " + error.message());
  } catch (const std::filesystem::filesystem_error& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(Code::io, "cannot write '" + path.string() + "': " + error.code().message());
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace crumble
