//! Writing GeoTIFF.

use super::tag;
use super::tag::GDAL_METADATA;
use std::io::Cursor;
use tiff::TiffResult;
use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression, TiffEncoder};
use tiff::tags::Tag;

/// A raster to be written.
#[derive(Debug, Clone, Copy)]
pub struct Image<'a> {
    /// Map position of the north-west corner (m).
    pub corner_m: [f64; 2],
    /// Side of a cell (m).
    pub cell_m: f64,
    /// Cells from west to east.
    pub columns: u32,
    /// Cells from north to south.
    pub rows: u32,
    /// EPSG code of the map coordinates.
    pub epsg: Option<u32>,
    /// Stands in `values` where there are no data.
    pub nodata: f32,
    /// Name and unit of the band, which stand where GDAL keeps them; a pure number has no unit.
    pub said: Option<(&'a str, &'a str)>,
    /// Row by row, the northern row first.
    pub values: &'a [f32],
}

/// One deflated band of 32-bit floats with the keys of OGC 19-008r4 (GeoTIFF 1.1): pixel is area, projected system by
/// its EPSG code where one is given.
///
/// # Errors
/// A size that TIFF cannot hold, or values that do not fill it.
pub fn encode(image: &Image) -> TiffResult<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let mut file = TiffEncoder::new(&mut bytes)?
        .with_compression(Compression::Deflate(DeflateLevel::default()));
    let mut written = file.new_image::<Gray32Float>(image.columns, image.rows)?;
    let [west_m, north_m] = image.corner_m;
    let tie = [0.0, 0.0, 0.0, west_m, north_m, 0.0];
    let scale = [image.cell_m, image.cell_m, 0.0];
    let unknown = |number| Tag::Unknown(number);
    let tags = written.encoder();
    tags.write_tag(unknown(tag::MODEL_PIXEL_SCALE), &scale[..])?;
    tags.write_tag(unknown(tag::MODEL_TIEPOINT), &tie[..])?;
    // GTModelType projected, GTRasterType pixel is area, ProjectedCRS
    let keys: Vec<u16> = match image.epsg.and_then(|code| u16::try_from(code).ok()) {
        Some(code) => vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, code],
        None => vec![1, 1, 0, 1, 1025, 0, 1, 1],
    };
    tags.write_tag(unknown(tag::GEO_KEY_DIRECTORY), &keys[..])?;
    if let Some((name, unit)) = image.said {
        let unit = match unit {
            "" => String::new(),
            unit => format!("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{unit}</Item>"),
        };
        let said = format!(
            "<GDALMetadata><Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{name}</Item>{unit}</GDALMetadata>"
        );
        tags.write_tag(unknown(GDAL_METADATA), said.as_str())?;
    }
    tags.write_tag(unknown(tag::GDAL_NODATA), image.nodata.to_string().as_str())?;
    written.write_data(image.values)?;
    Ok(bytes.into_inner())
}
