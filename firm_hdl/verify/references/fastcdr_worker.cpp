// Fast CDR, the serializer of ROS 2's default middleware, for any message type.
//
// Usage: fastcdr_worker. All numbers are little-endian and have 4 bytes, if nothing else is said.
//   in:  length, request        out: length, answer
//   request 'T' types           answer: one item
//   request 'E' count items     answer: as many items; an item in is a packed value
//   request 'D' count items     answer: as many items; an item in is a packet
// An item in is a length and bytes. One out is a byte, 0 or 1, a length, and bytes: 1 is a refusal,
// and the bytes are its text. Before anything is asked, one item is said: the release of Fast CDR.
//
// Types are lines, one for each message, each after those that it needs; the last one is asked for.
// A line has a word for each field: a letter, `m` and the number of the message's line, or one of
// these after `a` and its count and `:` (array), or `s` and its bound and `:` (sequence; 0: none).
// Packed values are those of values.py.
//
// Which call of Fast CDR a field needs is rosidl_typesupport_fastrtps_cpp's rule: a whole vector or
// array at once, where that does it; bounds are checked for sequences only; a bool alone is read as
// an octet; a message without fields is one octet. Two rules are those of the release:
//   Fast CDR 1 (ROS 2 humble, iron)  wide text goes through wstring, a wchar_t has 4 bytes
//   Fast CDR 2 (jazzy and later)     wide text goes unit by unit as uint32_t, a wchar_t has 2 bytes
// So a packed wide character has as many bytes as the release writes. Where ROS compiles nothing, as
// for a sequence of wide characters without a bound, they go one by one.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <sys/resource.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#ifndef FASTCDR_VERSION_STR
#define FASTCDR_VERSION_STR ""
#endif

#if FASTCDR_VERSION_MAJOR >= 2
#define SERIALIZE_ARRAY serialize_array
#define DESERIALIZE_ARRAY deserialize_array
#else
#define SERIALIZE_ARRAY serializeArray
#define DESERIALIZE_ARRAY deserializeArray
#endif

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

namespace {

struct Field {
  char shape = 0;  // 'a', 's', or 0: one of them
  uint32_t count = 0;
  char kind = 0;  // a letter, or 'm'
  size_t message = 0;
};

using Message = std::vector<Field>;

std::vector<Message> types;

#if FASTCDR_VERSION_MAJOR >= 2
using WideChar = uint16_t;
using WideText = std::u16string;
#else
using WideChar = uint32_t;
using WideText = std::wstring;
#endif

// What is packed, in and out.
struct Reader {
  const char * at;
  const char * end;

  const char * take(size_t size) {
    if (size > static_cast<size_t>(end - at)) {throw std::logic_error("packed value is too short");}
    at += size;
    return at - size;
  }
  template<typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  std::string text() {
    const uint32_t size = number<uint32_t>();
    return std::string(take(size), size);
  }
  WideText wide() {
    WideText found(number<uint32_t>(), 0);
    for (auto & unit : found) {unit = static_cast<char16_t>(number<uint32_t>());}
    return found;
  }
};

struct Writer {
  std::string data;

  template<typename T>
  void number(T value) {data.append(reinterpret_cast<const char *>(&value), sizeof(T));}
  void text(const std::string & value) {
    number(static_cast<uint32_t>(value.size()));
    data += value;
  }
  void wide(const WideText & value) {
    number(static_cast<uint32_t>(value.size()));
    for (auto unit : value) {number(static_cast<uint32_t>(static_cast<char16_t>(unit)));}
  }
};

// One value.
template<typename T>
void put(Cdr & cdr, Reader & in) {cdr << in.number<T>();}
template<>
void put<bool>(Cdr & cdr, Reader & in) {cdr << (in.number<uint8_t>() ? true : false);}
template<>
void put<std::string>(Cdr & cdr, Reader & in) {cdr << in.text();}
template<>
void put<WideText>(Cdr & cdr, Reader & in) {
  const WideText value = in.wide();
#if FASTCDR_VERSION_MAJOR >= 2
  cdr << static_cast<uint32_t>(value.size());
  for (auto unit : value) {cdr << static_cast<uint32_t>(unit);}
#else
  cdr << value;
#endif
}
template<>
void put<wchar_t>(Cdr & cdr, Reader & in) {cdr << static_cast<wchar_t>(in.number<WideChar>());}

template<typename T>
void get(Cdr & cdr, Writer & out) {
  T value;
  cdr >> value;
  out.number(value);
}
template<>
void get<bool>(Cdr & cdr, Writer & out) {
  uint8_t value;
  cdr >> value;
  out.number(static_cast<uint8_t>(value ? 1 : 0));
}
template<>
void get<std::string>(Cdr & cdr, Writer & out) {
  std::string value;
  cdr >> value;
  out.text(value);
}
template<>
void get<WideText>(Cdr & cdr, Writer & out) {
  WideText value;
#if FASTCDR_VERSION_MAJOR >= 2
  uint32_t size;
  cdr >> size;
  value.resize(size);
  for (auto & unit : value) {
    uint32_t read;
    cdr >> read;
    if (read > 0xFFFF) {throw std::range_error("a unit of wide text has more than 16 bits");}
    unit = static_cast<char16_t>(read);
  }
#else
  cdr >> value;
#endif
  out.wide(value);
}
template<>
void get<wchar_t>(Cdr & cdr, Writer & out) {
  wchar_t value;
  cdr >> value;
  out.number(static_cast<WideChar>(static_cast<char16_t>(value)));
}

// From packed values to what a generated C++ message has, and back.
template<typename T>
T load(Reader & in) {return in.number<T>();}
template<>
bool load<bool>(Reader & in) {return in.number<uint8_t>() != 0;}
template<>
std::string load<std::string>(Reader & in) {return in.text();}

template<typename T>
void save(Writer & out, const T & value) {out.number(value);}
void save(Writer & out, bool value) {out.number(static_cast<uint8_t>(value));}
void save(Writer & out, const std::string & value) {out.text(value);}

// Many of them; `each` says that they go one by one, which wide text and wide characters do.
template<typename T, bool each>
struct Many {
  static void put_array(Cdr & cdr, Reader & in, uint32_t count) {
    std::unique_ptr<T[]> values(new T[count]);
    for (uint32_t n = 0; n < count; ++n) {values[n] = load<T>(in);}
    cdr.SERIALIZE_ARRAY(values.get(), count);
  }
  static void get_array(Cdr & cdr, Writer & out, uint32_t count) {
    std::unique_ptr<T[]> values(new T[count]());
    cdr.DESERIALIZE_ARRAY(values.get(), count);
    for (uint32_t n = 0; n < count; ++n) {save(out, values[n]);}
  }
  static void put_sequence(Cdr & cdr, Reader & in) {
    std::vector<T> values(in.number<uint32_t>());
    for (size_t n = 0; n < values.size(); ++n) {values[n] = load<T>(in);}
    cdr << values;
  }
  static void get_sequence(Cdr & cdr, Writer & out) {
    std::vector<T> values;
    cdr >> values;
    out.number(static_cast<uint32_t>(values.size()));
    for (size_t n = 0; n < values.size(); ++n) {save(out, static_cast<T>(values[n]));}
  }
};

template<typename T>
struct Many<T, true> {
  static void put_array(Cdr & cdr, Reader & in, uint32_t count) {
    for (; count; --count) {put<T>(cdr, in);}
  }
  static void get_array(Cdr & cdr, Writer & out, uint32_t count) {
    for (; count; --count) {get<T>(cdr, out);}
  }
  static void put_sequence(Cdr & cdr, Reader & in) {
    const uint32_t count = in.number<uint32_t>();
    cdr << count;
    put_array(cdr, in, count);
  }
  static void get_sequence(Cdr & cdr, Writer & out) {
    uint32_t count;
    cdr >> count;
    out.number(count);
    get_array(cdr, out, count);
  }
};

template<typename T>
constexpr bool goes_whole() {
  return !std::is_same<T, bool>::value && !std::is_same<T, std::string>::value;
}

void check_bound(const Field & field, uint32_t count) {
  if (count > field.count) {throw std::length_error("sequence exceeds its bound");}
}

template<typename T, bool each = false>
void put_field(Cdr & cdr, Reader & in, const Field & field) {
  if (field.shape == 0) {
    put<T>(cdr, in);
  } else if (field.shape == 'a') {
    Many<T, each>::put_array(cdr, in, field.count);
  } else if (field.count == 0) {
    Many<T, each>::put_sequence(cdr, in);
  } else {
    const uint32_t count = in.number<uint32_t>();
    check_bound(field, count);
    cdr << count;
    if (count) {Many<T, each || !goes_whole<T>()>::put_array(cdr, in, count);}
  }
}

template<typename T, bool each = false>
void get_field(Cdr & cdr, Writer & out, const Field & field) {
  if (field.shape == 0) {
    get<T>(cdr, out);
  } else if (field.shape == 'a') {
    Many<T, each>::get_array(cdr, out, field.count);
  } else if (field.count == 0) {
    Many<T, each>::get_sequence(cdr, out);
  } else {
    uint32_t count;
    cdr >> count;
    check_bound(field, count);
    out.number(count);
    if (count) {Many<T, each || !goes_whole<T>()>::get_array(cdr, out, count);}
  }
}

void put_message(Cdr & cdr, Reader & in, const Message & message);
void get_message(Cdr & cdr, Writer & out, const Message & message);

void put_messages(Cdr & cdr, Reader & in, const Field & field) {
  uint32_t count = field.shape == 'a' ? field.count : 1;
  if (field.shape == 's') {
    count = in.number<uint32_t>();
    if (field.count) {check_bound(field, count);}
    cdr << count;
  }
  for (; count; --count) {put_message(cdr, in, types[field.message]);}
}

void get_messages(Cdr & cdr, Writer & out, const Field & field) {
  uint32_t count = field.shape == 'a' ? field.count : 1;
  if (field.shape == 's') {
    cdr >> count;
    if (field.count) {check_bound(field, count);}
    out.number(count);
  }
  for (; count; --count) {get_message(cdr, out, types[field.message]);}
}

#define EACH_KIND(call) \
  case '?': call<bool>(cdr, io, field); break; \
  case 'b': call<int8_t>(cdr, io, field); break; \
  case 'B': call<uint8_t>(cdr, io, field); break; \
  case 'h': call<int16_t>(cdr, io, field); break; \
  case 'H': call<uint16_t>(cdr, io, field); break; \
  case 'i': call<int32_t>(cdr, io, field); break; \
  case 'I': call<uint32_t>(cdr, io, field); break; \
  case 'q': call<int64_t>(cdr, io, field); break; \
  case 'Q': call<uint64_t>(cdr, io, field); break; \
  case 'f': call<float>(cdr, io, field); break; \
  case 'd': call<double>(cdr, io, field); break; \
  case 't': call<std::string>(cdr, io, field); break; \
  case 'w': call<WideText, true>(cdr, io, field); break; \
  case 'W': call<wchar_t, true>(cdr, io, field); break;

void put_message(Cdr & cdr, Reader & io, const Message & message) {
  if (message.empty()) {cdr << static_cast<uint8_t>(0);}
  for (const Field & field : message) {
    switch (field.kind) {
      EACH_KIND(put_field)
      default: put_messages(cdr, io, field);
    }
  }
}

void get_message(Cdr & cdr, Writer & io, const Message & message) {
  if (message.empty()) {
    uint8_t member;
    cdr >> member;
  }
  for (const Field & field : message) {
    switch (field.kind) {
      EACH_KIND(get_field)
      default: get_messages(cdr, io, field);
    }
  }
}

// Requests.
void read_types(const std::string & text) {
  types.clear();
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); ) {
    Message message;
    std::istringstream words(line);
    for (std::string word; words >> word; ) {
      Field field;
      size_t at = 0;
      const size_t colon = word.find(':');
      if (colon != std::string::npos) {
        field.shape = word[0];
        field.count = static_cast<uint32_t>(std::stoul(word.substr(1, colon - 1)));
        at = colon + 1;
      }
      field.kind = word.at(at);
      if (field.kind == 'm') {field.message = std::stoul(word.substr(at + 1));}
      message.push_back(field);
    }
    types.push_back(message);
  }
}

#if FASTCDR_VERSION_MAJOR >= 2
// As rmw_fastrtps does it.
struct RosCdr : Cdr {
  explicit RosCdr(FastBuffer & buffer)
  : Cdr(buffer, Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::CdrVersion::XCDRv1)
  {
    set_encoding_flag(eprosima::fastcdr::EncodingAlgorithmFlag::PLAIN_CDR);
  }
  size_t size() const {return get_serialized_data_length();}
};
#else
struct RosCdr : Cdr {
  explicit RosCdr(FastBuffer & buffer)
  : Cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {}
  size_t size() const {return getSerializedDataLength();}
};
#endif

size_t encode_into(FastBuffer & buffer, Reader in) {
  RosCdr cdr(buffer);
  cdr.serialize_encapsulation();
  put_message(cdr, in, types.back());
  if (in.at != in.end) {throw std::logic_error("packed value is too long");}
  return cdr.size();
}

std::string encode(Reader in) {
  // Fast CDR leaves out padding, so what the buffer had before stands there: zeros here. The size
  // is known after a first time.
  FastBuffer growing;
  std::string packet(encode_into(growing, in), '\0');
  FastBuffer buffer(&packet[0], packet.size());
  encode_into(buffer, in);
  return packet;
}

std::string decode(Reader in) {
  // Fast CDR takes a buffer that it might write to.
  std::string packet(in.at, in.end);
  FastBuffer buffer(&packet[0], packet.size());
  RosCdr cdr(buffer);
  cdr.read_encapsulation();
  Writer out;
  get_message(cdr, out, types.back());
  return out.data;
}

template<typename Work>
void item(Writer & answer, Work work) {
  uint8_t refused = 0;
  std::string said;
  try {
    said = work();
  } catch (const eprosima::fastcdr::exception::Exception & error) {
    // In some releases no std::exception.
    refused = 1;
    said = error.what();
  } catch (const std::exception & error) {
    refused = 1;
    said = error.what();
  }
  answer.number(refused);
  answer.text(said);
}

std::string answer_to(Reader request) {
  Writer answer;
  const char what = *request.take(1);
  if (what == 'T') {
    item(answer, [&] {
      read_types(std::string(request.at, request.end));
      return std::string();
    });
    return answer.data;
  }
  const uint32_t count = request.number<uint32_t>();
  for (uint32_t n = 0; n < count; ++n) {
    const uint32_t size = request.number<uint32_t>();
    const char * data = request.take(size);
    const Reader given{data, data + size};
    item(answer, [&] {return what == 'E' ? encode(given) : decode(given);});
  }
  return answer.data;
}

bool read_all(void * to, size_t size) {return std::fread(to, 1, size, stdin) == size;}

void say(const std::string & answer) {
  const uint32_t size = static_cast<uint32_t>(answer.size());
  std::fwrite(&size, sizeof(size), 1, stdout);
  std::fwrite(answer.data(), 1, size, stdout);
  std::fflush(stdout);
}

}  // namespace

int main() {
  const rlimit most{3ull << 30, 3ull << 30};
  setrlimit(RLIMIT_AS, &most);
  Writer hello;
  item(hello, [] {return std::string(FASTCDR_VERSION_STR);});
  say(hello.data);
  for (uint32_t size; read_all(&size, sizeof(size)); ) {
    std::string request(size, '\0');
    if (!read_all(&request[0], size)) {return 1;}
    say(answer_to(Reader{request.data(), request.data() + size}));
  }
  return 0;
}
