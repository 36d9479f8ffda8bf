#pragma once

namespace rubble::test {

/// Whether AddressSanitizer is compiled in: it holds freed memory back, so that what a process takes says nothing.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
constexpr bool kAddressSanitizer = __has_feature(address_sanitizer);
#else
constexpr bool kAddressSanitizer = false;
#endif

}  // namespace rubble::test
