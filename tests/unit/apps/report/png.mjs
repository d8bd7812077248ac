// Writes 8-bit RGB pictures as PNG data URLs.
import { deflateSync } from 'node:zlib';

function crc(bytes) {
    let rest = 0xffffffff;
    for (const byte of bytes) {
        rest ^= byte;
        for (let bit = 0; bit < 8; ++bit) rest = (rest >>> 1) ^ (rest & 1 ? 0xedb88320 : 0);
    }
    return (rest ^ 0xffffffff) >>> 0;
}

function chunk(type, data) {
    const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
    const size = Buffer.alloc(4),
        check = Buffer.alloc(4);
    size.writeUInt32BE(data.length);
    check.writeUInt32BE(crc(body));
    return Buffer.concat([size, body, check]);
}

/** A data URL of a picture whose pixels `colour(x, y)` gives as [r, g, b], 0 to 1. */
export function pngUrl(width, height, colour) {
    const rows = Buffer.alloc(height * (1 + 3 * width)); // each row begins with the filter type 0
    for (let y = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x) {
            colour(x, y).forEach((value, c) => {
                rows[y * (1 + 3 * width) + 1 + 3 * x + c] = Math.round(
                    255 * Math.max(0, Math.min(1, value)),
                );
            });
        }
    }
    const header = Buffer.alloc(13);
    header.writeUInt32BE(width, 0);
    header.writeUInt32BE(height, 4);
    header.set([8, 2], 8); // 8 bits, RGB
    const file = Buffer.concat([
        Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]),
        chunk('IHDR', header),
        chunk('IDAT', deflateSync(rows)),
        chunk('IEND', Buffer.alloc(0)),
    ]);
    return `data:image/png;base64,${file.toString('base64')}`;
}
