#include "tribound/io/file/vtu_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <span>

namespace tribound::io
{

namespace
{

/// Uncompressed bytes of a block, a multiple of the size of every number type.
constexpr std::size_t block_size = 1 << 18;

constexpr const char* byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

/// Whether an array that begins with this block is worth compressing, judged by a sample. Zeros and repeated
/// values are. The stresses of degree 2 only shrink to 0.6, and this takes longer than everything else, so
/// they are stored (bench/README.md).
bool is_worth_compressing(std::span<const std::byte> block, const Deflate& deflate,
                          std::span<std::byte> scratch)
{
  constexpr std::size_t sample_size = 1 << 14;
  constexpr double worth_it = 0.2;
  const auto sample = block.first(std::min(block.size(), sample_size));
  return static_cast<double>(deflate(sample, scratch).size()) <=
         worth_it * static_cast<double>(sample.size());
}

/// An offset that is not yet known; replaced in place, so that the header need not be written last.
struct Placeholder
{
  std::uint64_t position;
  std::size_t width;
};

std::string number(std::string_view name, double value)
{
  return fmt::format(
      "<DataArray type=\"Float64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>", name,
      value);
}

class VtuWriter
{
 public:
  explicit VtuWriter(const std::filesystem::path& path) : file_(path) {}

  void run(const VtuGrid& grid)
  {
    file_.write(fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n"
        "<UnstructuredGrid>\n"
        "<FieldData>{}{}</FieldData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        byte_order, number("TimeValue", grid.time),
        grid.load_factor ? number("t", *grid.load_factor) : std::string(), grid.n_points, grid.n_cells));
    declare("PointData", grid.point_data);
    declare("CellData", grid.cell_data);
    declare("Points", grid.points);
    declare("Cells", grid.cells);
    file_.write("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    data_begin_ = file_.position();
    for (const auto* section : {&grid.point_data, &grid.cell_data, &grid.points, &grid.cells})
      for (const VtuArray& array : *section) append(array);
    file_.write("\n</AppendedData>\n</VTKFile>\n");
    file_.commit();
  }

 private:
  void declare(std::string_view section, const std::vector<VtuArray>& arrays)
  {
    file_.write(fmt::format("<{}>\n", section));
    for (const VtuArray& array : arrays)
    {
      file_.write(
          fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" ",
                      array.type, array.name, array.n_components));
      constexpr std::string_view blank = "                              ";
      offsets_.push_back({file_.position(), blank.size()});
      file_.write(fmt::format("{}/>\n", blank));
    }
    file_.write(fmt::format("</{}>\n", section));
  }

  void append(const VtuArray& array)
  {
    const Placeholder& place = offsets_[n_appended_++];
    const std::string offset = fmt::format("offset=\"{}\"", file_.position() - data_begin_);
    assert(offset.size() <= place.width);
    file_.overwrite(place.position, std::as_bytes(std::span(offset)));
    VtuStream stream(file_, array.n_bytes);
    array.write(stream);
    stream.close();
  }

  AtomicFile file_;
  std::vector<Placeholder> offsets_;
  std::size_t n_appended_ = 0;
  std::uint64_t data_begin_ = 0;
};

}  // namespace

VtuStream::VtuStream(AtomicFile& file, std::uint64_t n_bytes)
    : file_(&file),
      header_position_(file.position()),
      header_(3 + (n_bytes + block_size - 1) / block_size),
      block_(block_size),
      deflate_(Deflate::fastest)
{
  header_[0] = header_.size() - 3;
  header_[1] = block_size;
  header_[2] = n_bytes % block_size;
  file.write(std::as_bytes(std::span(header_)));
}

void VtuStream::flush()
{
  assert(n_flushed_ + 3 < header_.size());  // not longer than announced
  const auto block = std::span(block_).first(used_);
  if (n_flushed_ == 0)
  {
    compressed_.resize(deflate_.bound(block_size));
    if (!is_worth_compressing(block, deflate_, compressed_))
    {
      deflate_ = Deflate(Deflate::stored);
      compressed_.resize(deflate_.bound(block_size));
    }
  }
  const std::span<const std::byte> compressed = deflate_(block, compressed_);
  header_[3 + n_flushed_++] = compressed.size();
  file_->write(compressed);
  used_ = 0;
}

void VtuStream::close()
{
  [[maybe_unused]] const std::size_t last = used_;
  if (used_ > 0) flush();
  assert(n_flushed_ + 3 == header_.size() && last % block_size == header_[2]);  // as long as announced
  file_->overwrite(header_position_, std::as_bytes(std::span(header_)));
}

std::vector<VtuArray> disjoint_cells(std::uint64_t n_cells, std::uint64_t n_nodes, std::uint8_t vtk_type)
{
  const std::uint64_t n_points = n_cells * n_nodes;
  return {vtu_array<std::int64_t>("connectivity", 1, n_points,
                                  [n_points](const auto& put)
                                  {
                                    for (std::uint64_t i = 0; i < n_points; ++i) put(i);
                                  }),
          vtu_array<std::int64_t>("offsets", 1, n_cells,
                                  [n_cells, n_nodes](const auto& put)
                                  {
                                    for (std::uint64_t c = 1; c <= n_cells; ++c) put(c * n_nodes);
                                  }),
          vtu_array<std::uint8_t>("types", 1, n_cells,
                                  [n_cells, vtk_type](const auto& put)
                                  {
                                    for (std::uint64_t c = 0; c < n_cells; ++c) put(vtk_type);
                                  })};
}

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid)
{
  VtuWriter(path).run(grid);
}

void write_vtu_list(const std::filesystem::path& path, const VtuGrid& grid,
                    std::span<const std::string> pieces)
{
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n",
      byte_order);
  const auto add = [&text](const char* element, std::span<const VtuArray> arrays)
  {
    text += fmt::format("<{}>\n", element);
    for (const VtuArray& array : arrays)
      text += fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", array.type,
                          array.name, array.n_components);
    text += fmt::format("</{}>\n", element);
  };
  add("PPointData", grid.point_data);
  add("PCellData", grid.cell_data);
  add("PPoints", grid.points);
  for (const std::string& piece : pieces) text += fmt::format("<Piece Source=\"{}\"/>\n", piece);
  write_file(path, text + "</PUnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace tribound::io
