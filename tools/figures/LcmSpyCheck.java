// Drives lcm-spy's own classes for tools/figures/ground_link.sh, with hovermodal_lcm.jar on the class path.
//   log FILE             finds every message's type by its fingerprint as lcm-spy does, decodes it, counts by channel
//   spy URL SECONDS PNG  lcm-spy itself: what its table lists after SECONDS, every channel's window opened, a picture
// Each prints lines "channel NAME type TYPE messages N errors N".
import java.awt.Frame;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.Toolkit;
import java.io.ByteArrayInputStream;
import java.io.DataInputStream;
import java.io.File;
import java.io.IOException;
import java.lang.reflect.Field;
import java.lang.reflect.Method;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import javax.imageio.ImageIO;
import javax.swing.SwingUtilities;
import lcm.logging.Log;
import lcm.spy.ChannelData;
import lcm.spy.LCMTypeDatabase;
import lcm.spy.Spy;

public class LcmSpyCheck {
  static void print(String channel, String type, long messages, long errors) {
    System.out.printf("channel %s type %s messages %d errors %d%n", channel, type, messages, errors);
  }

  static void readLog(String path) throws Exception {
    LCMTypeDatabase types = new LCMTypeDatabase();
    Map<String, long[]> counts = new TreeMap<>();
    Map<String, String> names = new TreeMap<>();
    Log log = new Log(path, "r");
    try {
      while (true) {
        Log.Event event = log.readNext();
        long[] count = counts.computeIfAbsent(event.channel, c -> new long[2]);
        long fingerprint = new DataInputStream(new ByteArrayInputStream(event.data)).readLong();
        Class<?> type = types.getClassByFingerprint(fingerprint);
        names.put(event.channel, type == null ? "unknown" : type.getSimpleName());
        try {
          type.getConstructor(byte[].class).newInstance((Object) event.data);
          count[0]++;
        } catch (Exception e) {
          count[1]++;
        }
      }
    } catch (IOException endOfLog) {
      // readNext() knows no other way to tell it
    }
    for (Map.Entry<String, long[]> one : counts.entrySet())
      print(one.getKey(), names.get(one.getKey()), one.getValue()[0], one.getValue()[1]);
  }

  @SuppressWarnings("unchecked")
  static List<ChannelData> channelsOf(Spy spy) throws Exception {
    Field field = Spy.class.getDeclaredField("channelList");
    field.setAccessible(true);
    List<ChannelData> all = (List<ChannelData>) field.get(spy);
    synchronized (all) {
      return new ArrayList<>(all);
    }
  }

  static void openViewers(Spy spy) throws Exception {
    Method open = Spy.class.getDeclaredMethod("createViewer", ChannelData.class);
    open.setAccessible(true);
    int n = 0;
    for (ChannelData channel : channelsOf(spy)) {
      if (channel.cls == null) continue;
      final int place = n++;
      SwingUtilities.invokeAndWait(() -> {
        try {
          open.invoke(spy, channel);
          if (channel.viewerFrame != null) channel.viewerFrame.setBounds(20 + 520 * (place % 3), 330 + 420 * (place / 3), 500, 400);
        } catch (Exception e) {
          System.err.println(channel.name + ": " + e.getCause());
        }
      });
    }
  }

  static void watch(String url, double seconds, String picture) throws Exception {
    Spy spy = new Spy(url);
    SwingUtilities.invokeAndWait(() -> {
      for (Frame frame : Frame.getFrames()) frame.setBounds(20, 10, 1100, 300);
    });
    Thread.sleep((long) (1000 * seconds));
    openViewers(spy);
    Thread.sleep(3000);
    for (ChannelData channel : channelsOf(spy))
      print(channel.name, channel.cls == null ? "unknown" : channel.cls.getSimpleName(), channel.nreceived, channel.nerrors);
    int viewers = 0;
    for (ChannelData channel : channelsOf(spy)) viewers += channel.viewer != null && channel.last != null ? 1 : 0;
    System.out.printf("windows %d%n", viewers);
    Rectangle all = new Rectangle(Toolkit.getDefaultToolkit().getScreenSize());
    ImageIO.write(new Robot().createScreenCapture(all), "png", new File(picture));
    System.exit(0);
  }

  public static void main(String[] arguments) throws Exception {
    if (arguments.length == 2 && arguments[0].equals("log")) {
      readLog(arguments[1]);
    } else if (arguments.length == 4 && arguments[0].equals("spy")) {
      watch(arguments[1], Double.parseDouble(arguments[2]), arguments[3]);
    } else {
      System.err.println("LcmSpyCheck log FILE | spy URL SECONDS PNG");
      System.exit(2);
    }
  }
}
