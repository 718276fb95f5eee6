#pragma once
// Numbers as text that a page reads back into typed arrays.
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <openssl/evp.h>

namespace elamin {

static_assert(std::endian::native == std::endian::little);   // as a browser's typed arrays are on every machine it runs on

/// The bytes of the numbers, least significant first, in base 64 (RFC 4648).
template <class Number> std::string base64(const std::vector<Number>& numbers) {
  const std::size_t bytes = numbers.size() * sizeof(Number);
  std::string text(4 * ((bytes + 2) / 3) + 1, '\0');                  // a zero is written behind it
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), reinterpret_cast<const unsigned char*>(numbers.data()), static_cast<int>(bytes));
  text.pop_back();
  return text;
}

}  // namespace elamin
